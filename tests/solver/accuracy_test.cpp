#include "solver/accuracy.h"

#include <gtest/gtest.h>

#include "solver/support.h"

namespace hemirad::test::accuracy_test {
namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

TEST(Dial, EveryStepIsFinerThanTheOneBefore) {
    for (unsigned step = 1; step <= kFinestStep; ++step) {
        const Accuracy coarser = accuracy_at(step - 1), finer = accuracy_at(step);
        EXPECT_GE(finer.resolution, coarser.resolution);
        EXPECT_GT(finer.shooter_samples, coarser.shooter_samples);
        EXPECT_LE(finer.sampling_error, coarser.sampling_error);
    }
}

TEST(Dial, StartsFinerForASmallerTarget) {
    EXPECT_EQ(first_step(1), 1u);
    EXPECT_EQ(first_step(1e-12), kFinestStep);
    for (double target = 1; target > 1e-6; target /= 2)
        EXPECT_LE(first_step(target), first_step(target / 2));
}

TEST(Dial, FillsInWhatIsLeftOpen) {
    SolverSettings settings{.resolution = 64, .shooter_samples = 0, .sampling_error = 0};

    set_accuracy(settings, {256, 4, 1e-5});

    EXPECT_EQ(settings.resolution, 64u);
    EXPECT_EQ(settings.shooter_samples, 4u);
    EXPECT_EQ(settings.sampling_error, 1e-5);
}

TEST(Dial, LeavesTheSamplesOfCountingToNearness) {
    SolverSettings settings{.resolution = 0, .form_factor = FormFactorMode::count};

    set_accuracy(settings, {256, 4, 1e-5});

    EXPECT_EQ(settings.resolution, 256u);
    EXPECT_EQ(settings.shooter_samples, 0u);
}

TEST(RelativeRmsDifference, IsWeighedByAreaAndOfTheWorstBand) {
    // Areas 1 and 4; the second band is twice as far off.
    const Mesh mesh = mesh_of({square({0, 0, 0}, kX, kY, 1), square({5, 0, 0}, kX, kY, 2)});
    Solution a, b;
    b.irradiance = {{10, 5}, {10, 5}};
    a.irradiance = {{11, 5}, {10, 6}};

    // Means are (10 + 4 * 5) / 5 = 6; squares 1 / 5 and 4 / 5.
    EXPECT_NEAR(relative_rms_difference(mesh, a, b), std::sqrt(0.8) / 6, 1e-12);
}

TEST(RelativeRmsDifference, IsTheSameHoweverStrongTheLight) {
    const Mesh mesh = mesh_of({square({0, 0, 0}, kX, kY, 1), square({5, 0, 0}, kX, kY, 2)});
    for (const double strength : {0x1p-1000, 1.0, 0x1p1000}) {
        Solution a, b;
        b.irradiance = {{10 * strength, 5 * strength}};
        a.irradiance = {{11 * strength, 5 * strength}};

        EXPECT_NEAR(relative_rms_difference(mesh, a, b), std::sqrt(0.2) / 6, 1e-12);
    }
}

TEST(RelativeRmsDifference, LeavesDarkBandsOut) {
    const Mesh mesh = mesh_of({square({0, 0, 0}, kX, kY, 1)});
    Solution a, b;
    a.irradiance = b.irradiance = {{0}, {2}};

    EXPECT_EQ(relative_rms_difference(mesh, a, b), 0);
}

TEST(RelativeRmsDifference, IsInfiniteToWhatHasReceivedNothing) {
    const Mesh mesh = mesh_of({square({0, 0, 0}, kX, kY, 1)});
    Solution a, b;
    a.irradiance = {{1}};
    b.irradiance = {{0}};

    EXPECT_TRUE(std::isinf(relative_rms_difference(mesh, a, b)));
}

TEST(MissingLight, IsThatOfTheWorstBand) {
    Solution solution;
    solution.ledger = {{10, 8, 0, 2}, {10, 4, 4, 2}, {0, 0, 0, 0}};

    EXPECT_EQ(missing_light(solution), 0.5);
}

// On a scene and a mesh that the dial was not made from.
TEST(Estimates, AreNotLessThanTheError) {
    const Mesh mesh = meshed(furnished_room(), 1.2);
    const auto solved = [&](SolverSettings how, const Accuracy& accuracy) {
        how.resolution = how.shooter_samples = 0;
        how.sampling_error = 0;
        how.form_factor = FormFactorMode::analytic;
        set_accuracy(how, accuracy);
        return solution_of(mesh, how);
    };
    const SolverSettings base = settings(0, 1e-2);
    const Solution truth = solved(base, {128, 8, 1e-6});

    const Solution draft = solved(base, accuracy_at(0)), medium = solved(base, accuracy_at(1));

    const double estimate = relative_rms_difference(mesh, draft, medium);
    EXPECT_LT(relative_rms_difference(mesh, medium, truth), estimate);
    EXPECT_LT(estimate, 2 * relative_rms_difference(mesh, draft, truth));
    EXPECT_LT(relative_rms_difference(mesh, medium, truth),
              0.6 * relative_rms_difference(mesh, draft, truth));
}

}  // namespace
}  // namespace hemirad::test::accuracy_test
