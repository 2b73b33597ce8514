#include <gtest/gtest.h>

#include "solver/solved.h"
#include "solver/support.h"

// A shooter's row of form factors is kept, and its later shots go by it.
namespace hemirad::test::known_rows_test {
namespace {

constexpr std::uint64_t kAnyBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kLeastEntries = 65536;  // of the lists

Solved solved(const Mesh& mesh, SolverSettings how, std::uint64_t row_bytes) {
    how.row_bytes = row_bytes;
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    EXPECT_EQ(solver.solve(go_on), Stop::converged);
    return {solver.solution(), solver.closure(), solver.repeated_shots()};
}

// Each fills the view of the square; only the lowest is seen.
std::vector<Polygon> square_under_ceilings(int ceilings) {
    std::vector<Polygon> polygons{square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)};
    for (int i = 0; i < ceilings; ++i)
        polygons.push_back(square({0, 0, 0.1 + 0.001 * i}, {0, 1, 0}, {1, 0, 0}, 9));
    return polygons;
}

std::uint64_t list_entries(const Mesh& mesh, const SolverSettings& how) {
    Shooters shooters(mesh, how.resolution, 1, how.pe_array);
    shooters.proxel_counts(0);
    return shooters.pipeline().shot().bin_entries;
}

mp1map::DeviceSummary roomy_device() {
    mp1map::DeviceSummary device{};
    device.global_memory = std::uint64_t{64} << 30;
    device.max_allocation = std::uint64_t{16} << 30;
    return device;
}

class KnownRows : public testing::TestWithParam<FormFactorMode> {
  protected:
    SolverSettings how() const {
        auto result = settings(64);
        result.form_factor = GetParam();
        result.shooter_samples = 2;
        return result;
    }
};

INSTANTIATE_TEST_SUITE_P(Modes, KnownRows,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) {
                             return mode.param == FormFactorMode::count ? "count" : "analytic";
                         });

TEST_P(KnownRows, GiveTheBitsOfLookingAgain) {
    // Light escapes from it, so that the books of escapes are shown as well.
    const Mesh mesh = meshed(scene_named("cornell.gltf"), 0.2);
    const std::uint64_t row = 4 * patch_arrays(mesh).stride;

    const auto none = solved(mesh, how(), 0);
    const auto some = solved(mesh, how(), 20 * row);
    const auto all = solved(mesh, how(), mesh.patches.size() * row);

    EXPECT_GT(none.solution.ledger[0].escaped, 0);
    EXPECT_EQ(none.repeated_shots, 0u);
    EXPECT_GT(some.repeated_shots, 0u);
    EXPECT_GE(all.repeated_shots, all.solution.shots - mesh.patches.size());
    EXPECT_GT(all.repeated_shots, some.repeated_shots);
    expect_equal(some, none);
    expect_equal(all, none);
}

TEST_P(KnownRows, AreThoseAfterTheListsWereEnlarged) {
    const Mesh mesh = mesh_of(square_under_ceilings(40), 0.7);
    auto how = this->how();
    how.resolution = 256;
    how.tolerance = 1e-5;
    how.pe_array = {4, 1, 16, 64, 64};
    const auto room = solved(mesh, how, 0);
    how.pe_array = {1, 1, 4, 4, 4};

    const auto enlarged = solved(mesh, how, kAnyBytes);

    ASSERT_GT(list_entries(mesh, how), kLeastEntries);
    EXPECT_GT(enlarged.repeated_shots, 0u);
    expect_equal(enlarged, room);
}

TEST_P(KnownRows, GoOnOverPauses) {
    const Mesh mesh = meshed(scene_named("cornell.gltf"), 0.2);
    auto how = this->how();
    const auto whole = solved(mesh, how, kAnyBytes);
    how.stop_every = {7};

    expect_equal(solved(mesh, how, kAnyBytes), whole);
}

// Each time others are to shoot next, and to have rows.
TEST_P(KnownRows, FindAsMuchRoomWhenTheStateWasSetManyTimes) {
    const Mesh mesh = meshed(scene_named("furnace.obj"), 0.25);
    auto how = this->how();
    how.salvo = 8;
    how.row_bytes = 60'000;
    const auto device = mp1map::Device::open("");
    ProgressiveSolver once(mesh, how, device), often(mesh, how, device);

    for (int i = 0; i < 3000; ++i) often.resume(often.state());
    EXPECT_EQ(once.solve(go_on), Stop::converged);
    EXPECT_EQ(often.solve(go_on), Stop::converged);

    EXPECT_EQ(once.repeated_shots(), once.solution().shots - mesh.patches.size());
    EXPECT_EQ(often.repeated_shots(), once.repeated_shots());
}

TEST(RowBytes, AreAQuarterOfTheDeviceAtMost) {
    auto device = roomy_device();
    EXPECT_EQ(usable_row_bytes({}, 1000, 1000, device), std::uint64_t{1} << 30);
    EXPECT_EQ(usable_row_bytes(std::uint64_t{20} << 30, 1000, 1000, device),
              std::uint64_t{16} << 30);
    device.max_allocation = std::uint64_t{3} << 30;
    EXPECT_EQ(usable_row_bytes(std::uint64_t{20} << 30, 1000, 1000, device),
              std::uint64_t{3} << 30);
}

// 1 GiB holds 2684 rows of 100,000 patches, 268 of a million.
TEST(RowBytes, AreNoneByDefaultWhereFewerThanOneShooterInAHundredHasARow) {
    const auto device = roomy_device();
    constexpr std::uint64_t kGibibyte = std::uint64_t{1} << 30;
    EXPECT_EQ(usable_row_bytes({}, 268'000, 100'000, device), kGibibyte);
    EXPECT_EQ(usable_row_bytes({}, 269'000, 100'000, device), 0u);
    EXPECT_EQ(usable_row_bytes({}, 26'000, 1'000'000, device), kGibibyte);
    EXPECT_EQ(usable_row_bytes(kGibibyte, 1'000'000, 1'000'000, device), kGibibyte);
}

// Rows without zeros, and what 64 PEs of an array may leave of theirs.
TEST(RowBytes, AreNoMoreThanTheRowsOfAllShootersTake) {
    const auto bytes = [](std::uint64_t row_bytes) {
        return estimated_device_bytes(1024, 1024, 4, 1, 64, FormFactorMode::count, row_bytes,
                                      {4, 1, 16, 64, 64});
    };
    EXPECT_GT(bytes(std::uint64_t{1} << 40) - bytes(0), 1024 * 4 * 1024);
    EXPECT_LT(bytes(std::uint64_t{1} << 40) - bytes(0), 1024 * 5 * 1024);
}

TEST(RowBytes, LeaveAMillionPatchesWithin300BytesEach) {
    constexpr std::uint32_t kPatches = 1'000'000;
    const auto device = roomy_device();
    const auto bytes = estimated_device_bytes(
        kPatches, kPatches, 4, 3, 512, FormFactorMode::analytic,
        usable_row_bytes({}, kPatches, kPatches, device), {4, 1, 16, 64, 64});
    EXPECT_LE(bytes, std::uint64_t{300} * kPatches);
}

}  // namespace
}  // namespace hemirad::test::known_rows_test
