#include <gtest/gtest.h>

#include "solver/support.h"

// Patches by tiles are lists in one buffer, sized for patches that touch few tiles. Where they
// outgrow it a shot halts (kBinsFull), the host makes room, and the shot is made again.
namespace hemirad::test::full_lists_test {
namespace {

constexpr int kHuge = 20000;
const mp1map::PeArrayRequest kFineTiles{2, 1, 4, 8, 8}, kOneTile{4, 1, 16, 64, 64};

Mesh huge_triangles() { return mesh_of(soup(kHuge, 1.0, 5), 0.7); }

Solution after_shots(const Mesh& mesh, SolverSettings how, const mp1map::PeArrayRequest& request) {
    how.pe_array = request;
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    EXPECT_EQ(solver.solve(go_on), Stop::max_shots);
    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    return solver.solution();
}

std::uint64_t list_entries(const Mesh& mesh, std::uint32_t resolution,
                           const mp1map::PeArrayRequest& request) {
    Shooters shooters(mesh, resolution, 1, request);
    shooters.proxel_counts(0);
    return shooters.pipeline().shot().bin_entries;
}

TEST(FullLists, GiveTheBitsOfARunWithRoom) {
    const Mesh mesh = huge_triangles();
    ASSERT_LT(list_entries(mesh, 64, kOneTile), 4u * kHuge);
    ASSERT_GT(list_entries(mesh, 64, kFineTiles), 4u * kHuge + 64);

    const auto room = after_shots(mesh, settings(64, 1e-3, 30), kOneTile);
    const auto full = after_shots(mesh, settings(64, 1e-3, 30), kFineTiles);

    EXPECT_EQ(room.shots, 30u);
    EXPECT_EQ(full.shots, 30u);
    EXPECT_EQ(room.irradiance, full.irradiance);
    EXPECT_EQ(room.unshot_fraction, full.unshot_fraction);
    EXPECT_EQ(room.ledger[0].escaped, full.ledger[0].escaped);
}

TEST(FullLists, AreRepeatedWithRoomAtFullResolution) {
    const Mesh mesh = huge_triangles();
    Shooters shooters(mesh, 512);
    const auto halted = shooters.proxel_counts(0);
    ASSERT_EQ(shooters.pipeline().shot().status, kBinsFull);
    for (const auto count : halted) ASSERT_EQ(count, 0);

    shooters.pipeline().enlarge_lists();
    const auto counts = shooters.proxel_counts(0);
    EXPECT_NE(shooters.pipeline().shot().status, kBinsFull);
    const auto whole = shooters.count(0, 0);
    EXPECT_EQ(whole.owned + whole.escaped, disk_proxel_count(512));
    EXPECT_EQ(shooters.proxel_counts(0), counts);

    const auto solution = after_shots(mesh, settings(512, 1e-3, 3), {});
    EXPECT_EQ(solution.shots, 3u);
    EXPECT_LT(solution.ledger[0].residual(), 1e-5);
}

// Screens that only the second hemisphere of the shooter sees: the first has been projected when
// the shot halts, and must not count twice.
TEST(FullLists, InALaterHemisphereForgetTheEarlierOnes) {
    std::vector<Polygon> polygons = {square({0, 0, -0.9}, {1, 0, 0}, {0, 1, 0}, 1.0)};
    polygons.push_back(square({0, 0, 0.9}, {0, 1, 0}, {1, 0, 0}, 1.5));
    for (int i = 0; i < 3000; ++i)
        polygons.push_back(square({-0.1 + 1e-5 * i, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1.7));
    Mesh mesh = mesh_of(polygons, 0.5, 0);
    mesh.materials.push_back({"lamp", {0.5}, {1}, false});
    mesh.surfaces[0].material = 1;
    for (const auto& request : {kFineTiles, kOneTile}) {
        Shooters shooters(mesh, 64, 2, request);
        shooters.proxel_counts(0);
        EXPECT_EQ(shooters.pipeline().shot().status == kBinsFull,
                  request.width == kFineTiles.width);
        shooters.count(0, 0);
        EXPECT_LT(shooters.pipeline().shot().bin_entries, 65536u);
    }

    auto how = settings(64, 1e-3, 5);
    how.shooter_samples = 2;
    const auto full = after_shots(mesh, how, kFineTiles), room = after_shots(mesh, how, kOneTile);

    EXPECT_EQ(room.irradiance, full.irradiance);
    EXPECT_EQ(room.shots, full.shots);
}

}  // namespace
}  // namespace hemirad::test::full_lists_test
