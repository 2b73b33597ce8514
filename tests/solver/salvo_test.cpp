#include <gtest/gtest.h>

#include "solver/lightmap_bytes.h"
#include "solver/support.h"

// Several patches shoot at once, and look at once or ahead.
namespace hemirad::test::salvo_test {
namespace {

constexpr std::uint64_t kAnyBytes = std::uint64_t{1} << 30;

struct Solved {
    Solution solution;
    Closure closure;
    std::uint64_t repeated_shots;
};

Solved solved(const Mesh& mesh, const SolverSettings& how) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    solver.solve(go_on);
    return {solver.solution(), solver.closure(), solver.repeated_shots()};
}

Mesh box() { return meshed(scene_named("cornell.gltf"), 0.12); }

void expect_equal(const Solution& a, const Solution& b) {
    EXPECT_EQ(a.shots, b.shots);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.unshot_fraction, b.unshot_fraction);
    for (std::size_t band = 0; band < a.ledger.size(); ++band) {
        EXPECT_EQ(a.ledger[band].escaped, b.ledger[band].escaped);
        EXPECT_EQ(a.ledger[band].unshot, b.ledger[band].unshot);
    }
}

// What is left unshot at the end is all that may differ.
void expect_near(const Solution& a, const Solution& b) {
    const auto& irradiance = b.irradiance[0];
    const double mean = std::accumulate(irradiance.begin(), irradiance.end(), 0.0) /
                        static_cast<double>(irradiance.size());
    for (std::size_t i = 0; i < irradiance.size(); ++i)
        EXPECT_NEAR(a.irradiance[0][i], irradiance[i], 1e-5 * mean);
}

class Salvo : public testing::TestWithParam<FormFactorMode> {
  protected:
    SolverSettings how(std::uint32_t salvo, double tolerance = 1e-3) const {
        auto result = settings(64, tolerance);
        result.form_factor = GetParam();
        result.shooter_samples = 2;
        result.salvo = salvo;
        return result;
    }
};

INSTANTIATE_TEST_SUITE_P(Modes, Salvo,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) {
                             return mode.param == FormFactorMode::count ? "count" : "analytic";
                         });

TEST_P(Salvo, ConvergesToTheSolutionOfOneAtATime) {
    const Mesh mesh = box();
    const auto one = solved(mesh, how(1, 1e-6));
    for (const std::uint32_t salvo : {8u, kMostSalvo}) {
        const auto several = solved(mesh, how(salvo, 1e-6));

        EXPECT_TRUE(several.solution.converged);
        EXPECT_NEAR(several.closure.least, 1, 0);
        EXPECT_NEAR(several.closure.most, 1, 0);
        EXPECT_LT(std::abs(several.solution.ledger[0].residual()), 1e-6);
        expect_near(several.solution, one.solution);
    }
}

TEST_P(Salvo, WhatEachPatchShotAddsUpToAllShotsAndCountingChangesNoBit) {
    const Mesh mesh = box();
    auto counted = how(8);
    counted.count_shots = true;

    const auto plain = solved(mesh, how(8)).solution;
    const auto solution = solved(mesh, counted).solution;

    expect_equal(solution, plain);
    EXPECT_TRUE(plain.shots_of.empty());
    ASSERT_EQ(solution.shots_of.size(), mesh.patches.size());
    EXPECT_EQ(std::accumulate(solution.shots_of.begin(), solution.shots_of.end(), std::uint64_t{0}),
              solution.shots);
}

TEST_P(Salvo, TakesFewMoreShots) {
    const Mesh mesh = box();
    const auto one = solved(mesh, how(1)).solution.shots;

    const auto eight = solved(mesh, how(8)).solution.shots;

    EXPECT_LT(static_cast<double>(eight), 1.05 * static_cast<double>(one));
}

TEST_P(Salvo, HasTheBitsOfEveryRowMemory) {
    const Mesh mesh = box();
    const std::uint64_t row = 4 * patch_arrays(mesh).stride;
    auto how = this->how(8);
    how.row_bytes = 0;
    const auto none = solved(mesh, how);
    how.row_bytes = 60 * row;
    const auto some = solved(mesh, how);
    how.row_bytes = kAnyBytes;
    const auto all = solved(mesh, how);

    EXPECT_EQ(none.repeated_shots, 0u);
    EXPECT_GT(all.repeated_shots, some.repeated_shots);
    // Some have looked before they shot for the first time.
    EXPECT_GT(all.repeated_shots, all.solution.shots - mesh.patches.size());
    expect_equal(some.solution, none.solution);
    expect_equal(all.solution, none.solution);
}

TEST_P(Salvo, GoesOnOverPausesWithTheSameBits) {
    const Mesh mesh = box();
    auto how = this->how(8);
    const auto whole = solved(mesh, how).solution;
    how.stop_every = {5};

    expect_equal(solved(mesh, how).solution, whole);
}

// In a furnace all patches have light from the beginning.
TEST_P(Salvo, NeverExceedsTheMostShots) {
    const Mesh mesh = meshed(scene_named("furnace.obj"), 0.25);
    for (const std::uint64_t most : {1u, 13u, 16u}) {
        auto how = this->how(8);
        how.max_shots = most;
        EXPECT_EQ(solved(mesh, how).solution.shots, most);
    }
}

TEST(Salvos, HaveTheSameBitsOnEveryMachine) {
    auto how = settings(150, 1e-3, 150);
    how.form_factor = FormFactorMode::analytic;
    how.salvo = 8;
    expect_same_bytes(meshed(scene_named("cornell.gltf"), 0.06), how,
                      {{"default", {}},
                       {"lanes 1", {0, 0, 1, 0, 0}},
                       {"16x16 PEs, lanes 4", {16, 16, 4, 0, 0}},
                       {"1 compute unit", {}, 1}});
}

// Some shooters of a salvo have fewer hemispheres than others, and wait for them.
TEST(Salvos, MayHaveDifferentNumbersOfHemispheres) {
    const Mesh mesh = meshed(furnished_room(), 0.75);
    auto how = settings(64, 1e-6);
    how.shooter_samples = 0;
    how.sampling_error = 0.02;
    const auto samples = shooter_samples_for(mesh, how.sampling_error, 8);
    ASSERT_LT(*std::ranges::min_element(samples), *std::ranges::max_element(samples));
    const auto one = solved(mesh, how).solution;
    how.salvo = 8;
    how.row_bytes = 0;
    const auto several = solved(mesh, how);

    EXPECT_EQ(several.closure.least, 1);
    EXPECT_EQ(several.closure.most, 1);
    expect_near(several.solution, one);
}

TEST(Salvos, OfPatchesWithElementsConvergeToTheirSolution) {
    const Mesh mesh = build_mesh(furnished_room(),
                                 {.patch_size = 1, .element_size = 0.4, .max_reflectance = 0.995});
    ASSERT_FALSE(mesh.shooters.empty());
    auto how = settings(64, 1e-6);
    const auto one = solved(mesh, how).solution;
    how.salvo = 8;
    for (const std::uint64_t row_bytes : {std::uint64_t{0}, kAnyBytes}) {
        how.row_bytes = row_bytes;
        const auto several = solved(mesh, how).solution;
        expect_near(several, one);
    }
}

// Where one's lists are full all look again, with room.
TEST(Salvos, HaveTheBitsOfARunWithRoomForTheirLists) {
    const Mesh mesh = mesh_of(soup(20000, 1.0, 5), 0.7);
    auto how = settings(64, 1e-3, 32);
    how.salvo = 8;
    how.pe_array = {4, 1, 16, 64, 64};
    const auto room = solved(mesh, how);
    how.pe_array = {2, 1, 4, 8, 8};
    const auto full = solved(mesh, how);

    EXPECT_EQ(full.closure.least, 1);
    EXPECT_EQ(full.closure.most, 1);
    expect_equal(full.solution, room.solution);
}

TEST(Salvos, LeaveTheRowsWithinTheirMemory) {
    constexpr std::uint64_t kBytes = 50 * 4 * 1024;
    const auto bytes = [](std::uint64_t row_bytes) {
        return estimated_device_bytes(1024, 1024, 4, 1, 64, FormFactorMode::count, row_bytes,
                                      {4, 1, 16, 64, 64}, 8);
    };
    EXPECT_LE(bytes(kBytes) - bytes(0), kBytes);
    EXPECT_GT(bytes(kBytes) - bytes(0), kBytes - 128);
}

TEST(Salvos, AreOfEightUnlessTimeOrMemoryIsNoMatter) {
    EXPECT_EQ(usable_salvo(0, 1023, 1023, 128), 1u);
    EXPECT_EQ(usable_salvo(0, 1024, 1024, 2048), 8u);
    EXPECT_EQ(usable_salvo(0, 1024, 262'144, 128), 8u);
    EXPECT_EQ(usable_salvo(0, 262'145, 262'145, 128), 1u);
    EXPECT_EQ(usable_salvo(0, 1024, 1024, 2049), 1u);
    EXPECT_EQ(usable_salvo(3, 10, 10, 8192), 3u);
    EXPECT_EQ(usable_salvo(1000, 10, 10, 128), kMostSalvo);
}

}  // namespace
}  // namespace hemirad::test::salvo_test
