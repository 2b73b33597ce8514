#include <gtest/gtest.h>

#include "solver/support.h"

// Counts + escaped = proxels in the disk, and none escapes from a closed scene: no proxel is lost
// between two patches that share an edge, or a part of one (T-junctions).
namespace hemirad::test {
namespace {

/// Whether a patch touches the front of another with its own, as the bottom of a crate does the
/// floor's: nothing sees it, and it sees nothing.
bool is_pressed_shut(const Mesh& mesh, const Patch& patch) {
    const auto centre = mesh.centroid(patch), normal = mesh.normal(patch);
    for (const auto& other : mesh.patches) {
        const auto& corner = mesh.vertices[other.corners[0]];
        if (std::abs(glm::dot(normal, corner - centre)) > 1e-9) continue;
        if (glm::dot(normal, mesh.normal(other)) > 0) continue;
        bool inside = true;
        for (int k = 0; k < 4; ++k) {
            const auto &a = mesh.vertices[other.corners[k]],
                       &b = mesh.vertices[other.corners[(k + 1) % 4]];
            inside = inside && glm::dot(glm::cross(b - a, centre - a), normal) <= 1e-9;
        }
        if (inside) return true;
    }
    return false;
}

/// Shoots from every `step`-th patch, from a part of it that changes from one to the next.
/// Returns the proxels it looked through.
std::uint64_t expect_nothing_escapes(const Mesh& mesh, std::uint32_t resolution,
                                     std::uint32_t step = 1) {
    EXPECT_TRUE(mesh.closed);
    Shooters shooters(mesh, resolution, 3);
    std::uint64_t proxels = 0, escaped = 0, shots = 0;
    for (std::uint32_t patch = 0; patch < shooters.patch_count(); patch += step) {
        if (is_pressed_shut(mesh, mesh.patches[patch])) continue;
        const std::uint32_t part = static_cast<std::uint32_t>(shots % shooters.part_count());
        const auto count = shooters.count(patch, part);
        EXPECT_EQ(count.owned + count.escaped, shooters.proxels_a_part());
        EXPECT_EQ(count.escaped, 0u) << "shooter " << patch << ", part " << part << ", resolution "
                                     << resolution;
        proxels += count.owned + count.escaped;
        escaped += count.escaped;
        ++shots;
    }
    testing::Test::RecordProperty("proxels", std::to_string(proxels));
    std::printf("%llu proxels of %llu shooters, %llu escaped\n",
                static_cast<unsigned long long>(proxels), static_cast<unsigned long long>(shots),
                static_cast<unsigned long long>(escaped));
    return proxels;
}

TEST(Closure, NothingEscapesFromTheFurnace) {
    for (const std::uint32_t resolution : {64u, 100u, 256u})
        for (const double patch_size : {1.0, 0.5, 0.13})
            expect_nothing_escapes(meshed(scene_named("furnace.obj"), patch_size), resolution,
                                   patch_size < 0.2 ? 5 : 1);
}

TEST(Closure, NothingEscapesFromTheLRoom) {
    expect_nothing_escapes(meshed(scene_named("lroom.obj"), 0), 256, 3);
}

TEST(Closure, NothingEscapesFromTheSmallHall) {
    expect_nothing_escapes(meshed(scene_named("hall2k.obj"), 0), 256, 5);
}

TEST(Closure, NothingEscapesFromTheLargeHall) {
    expect_nothing_escapes(meshed(scene_named("hall14k.obj"), 0), 256, 97);
}

TEST(Closure, NothingEscapesThroughTJunctionsOfRotatedRooms) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(0.3, 1.5);
    for (int round = 0; round < 12; ++round) {
        const Scene scene = rotated(furnished_room(), random_rotation(random));
        expect_nothing_escapes(meshed(scene, size(random)), round % 2 == 0 ? 64 : 256, 2);
    }
}

TEST(Closure, NothingEscapesFromARotatedHall) {
    std::mt19937 random(2);
    const Scene scene = rotated(scene_named("hall2k.obj"), random_rotation(random));
    expect_nothing_escapes(meshed(scene, 0.41), 256, 17);
}

TEST(Closure, IsExactForEveryShotOfAnOpenScene) {
    const Mesh mesh = meshed(scene_named("squares.obj"), 0.25);
    const auto device = mp1map::Device::open("");
    auto how = settings(64);
    how.shooter_samples = 2;
    ProgressiveSolver solver(mesh, how, device);

    solver.solve(go_on);

    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    EXPECT_GT(solver.solution().ledger[0].escaped, 0);
}

}  // namespace
}  // namespace hemirad::test
