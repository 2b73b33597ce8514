#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "errors.h"
#include "solver/support.h"

// Every solve ends, at the tolerance or at a limit, and says which.
namespace hemirad::test::stopping_test {
namespace {

/// A solver with its own copy of everything it needs.
struct Solving {
    Mesh mesh;
    mp1map::Device device = mp1map::Device::open("");
    ProgressiveSolver solver;

    Solving(Mesh scene, const SolverSettings& how)
        : mesh(std::move(scene)), solver(mesh, how, device) {}
};

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

Mesh facing_squares() { return meshed(scene_named("squares.obj"), 0.25); }

TEST(Stopping, ALightWithoutReceiverLosesAll) {
    Solving run(mesh_of({square({0, 0, 0}, kX, kY, 1)}, 0.5, 1.0), settings(64));

    EXPECT_EQ(run.solver.solve(go_on), Stop::converged);

    const Solution solution = run.solver.solution();
    EXPECT_EQ(solution.shots, 1u);
    EXPECT_TRUE(solution.converged);
    EXPECT_EQ(solution.unshot_fraction, 0);
    EXPECT_EQ(solution.irradiance[0][0], 0);
    EXPECT_FLOAT_EQ(static_cast<float>(solution.radiosity[0][0]), 3.14159265f);
    EXPECT_NEAR(solution.ledger[0].escaped / solution.ledger[0].emitted, 1, 1e-6);
    EXPECT_EQ(solution.ledger[0].absorbed, 0);
}

TEST(Stopping, ASceneWithoutLightIsDone) {
    Solving run(mesh_of(box({1, 1, 1}, 2), 0.5, 0.0), settings(64));

    EXPECT_EQ(run.solver.solve(go_on), Stop::converged);

    const Solution solution = run.solver.solution();
    EXPECT_EQ(solution.shots, 0u);
    EXPECT_EQ(solution.unshot_fraction, 0);
    for (const double value : solution.irradiance[0]) EXPECT_EQ(value, 0);
    EXPECT_EQ(solution.ledger[0].residual(), 0);
    EXPECT_EQ(run.solver.closure().least, 1);
}

TEST(Stopping, AnOpenSceneConverges) {
    Solving run(facing_squares(), settings(64, 1e-5));

    EXPECT_EQ(run.solver.solve(go_on), Stop::converged);

    const Solution solution = run.solver.solution();
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(solution.unshot_fraction, 1e-5);
    EXPECT_GT(solution.ledger[0].escaped, 0.5 * solution.ledger[0].emitted);
}

TEST(Stopping, AtMostSoManyShots) {
    Solving run(facing_squares(), settings(64, 1e-9, 5));

    EXPECT_EQ(run.solver.solve(go_on), Stop::max_shots);
    EXPECT_EQ(run.solver.solve(go_on), Stop::max_shots);

    EXPECT_EQ(run.solver.solution().shots, 5u);
    EXPECT_FALSE(run.solver.solution().converged);
}

TEST(Stopping, AtATimeLimit) {
    auto how = settings(128, 1e-9);
    how.time_limit = 0.3;
    Solving run(meshed(furnished_room(), 0.3), how);

    EXPECT_EQ(run.solver.solve(go_on), Stop::time_limit);

    EXPECT_GT(run.solver.solution().shots, 0u);
    EXPECT_LT(run.solver.solution().ledger[0].residual(), 1e-5);
}

TEST(Stopping, WhereTheCallbackSaysSo) {
    Solving run(meshed(furnished_room(), 0.75), settings(64, 1e-6));
    std::uint64_t calls = 0, shots = 0;

    EXPECT_EQ(run.solver.solve([&](const Progress& progress) {
        shots = progress.shots;
        return ++calls < 4;
    }),
              Stop::interrupted);

    EXPECT_EQ(calls, 4u);
    EXPECT_EQ(run.solver.solution().shots, shots);
}

TEST(Stopping, CallsBackAtEveryMultiple) {
    auto how = settings(64, 1e-9, 50);
    how.stop_every = {10};
    Solving run(meshed(furnished_room(), 0.75), how);
    std::vector<std::uint64_t> multiples;

    run.solver.solve([&](const Progress& progress) {
        if (progress.shots % 10 == 0) multiples.push_back(progress.shots);
        return true;
    });

    EXPECT_EQ(multiples, (std::vector<std::uint64_t>{10, 20, 30, 40, 50}));
}

TEST(Stopping, PausesAtMultiplesOfEachIntervalAndNotOfTheirDivisors) {
    auto how = settings(64, 1e-9, 40);
    how.stop_every = {15, 14};
    how.salvo = 1;
    Solving run(meshed(furnished_room(), 0.75), how);
    std::vector<std::uint64_t> pauses;

    run.solver.solve([&](const Progress& progress) {
        pauses.push_back(progress.shots);
        return true;
    });

    for (const std::uint64_t due : {14, 15, 28, 30, 40})
        EXPECT_EQ(std::ranges::count(pauses, due), 1) << due;
    EXPECT_LT(pauses.size(), 30u);  // a pause after each shot would be 40
}

TEST(Stopping, UnshotNeverRises) {
    auto how = settings(64);
    how.stop_every = {1};
    Solving run(meshed(furnished_room(), 0.75), how);
    double unshot = 1 + 1e-6;

    run.solver.solve([&](const Progress& progress) {
        EXPECT_LE(progress.unshot_fraction, unshot + 1e-6) << progress.shots;
        unshot = progress.unshot_fraction;
        return progress.shots < 200;
    });
}

Mesh box_of_bands(const std::vector<double>& reflectances, const std::vector<double>& emissions) {
    Mesh mesh = mesh_of(box({1, 1, 1}, 1));
    mesh.bands.clear();
    for (std::size_t band = 0; band < reflectances.size(); ++band)
        mesh.bands.push_back("band" + std::to_string(band));
    mesh.materials = {{"wall", reflectances, emissions, false}};
    return mesh;
}

// Closed forms for all pairs: in an empty box nothing is left to proxels.
SolverSettings exact_settings(double tolerance) {
    SolverSettings result = settings(64, tolerance);
    result.form_factor = FormFactorMode::analytic;
    result.sampling_error = 1e-6;
    return result;
}

TEST(Bands, ThatAreDarkStayDarkAndHoldNothingUp) {
    Solving run(box_of_bands({0.5, 0.9, 0.2}, {1, 0, 3}), exact_settings(1e-5));

    EXPECT_EQ(run.solver.solve(go_on), Stop::converged);

    const Solution solution = run.solver.solution();
    for (std::size_t patch = 0; patch < 6; ++patch) {
        EXPECT_NEAR(solution.radiosity[0][patch], std::numbers::pi * 2, 1e-3);
        EXPECT_EQ(solution.radiosity[1][patch], 0);
        EXPECT_NEAR(solution.radiosity[2][patch], std::numbers::pi * 3 / 0.8, 1e-3);
    }
    EXPECT_EQ(solution.ledger[1].emitted, 0);
    EXPECT_EQ(solution.ledger[1].residual(), 0);
}

TEST(Bands, MayBeAsManyAsTheFileNames) {
    std::vector<double> reflectances, emissions;
    for (int band = 0; band < 31; ++band) {
        reflectances.push_back(0.025 * band);
        emissions.push_back(1 + 0.5 * band);
    }
    Solving run(box_of_bands(reflectances, emissions), exact_settings(1e-5));

    EXPECT_EQ(run.solver.solve(go_on), Stop::converged);

    const Solution solution = run.solver.solution();
    ASSERT_EQ(solution.bands.size(), 31u);
    EXPECT_EQ(solution.bands[30], "band30");
    for (std::size_t band = 0; band < 31; ++band)
        for (const double value : solution.radiosity[band])
            EXPECT_NEAR(value / (std::numbers::pi * emissions[band] / (1 - reflectances[band])), 1,
                        1e-4);
}

TEST(Bands, OfAGreySceneAreSolvedOnce) {
    Solving grey(box_of_bands({0.5, 0.5, 0.5}, {1, 1, 1}), settings(64));
    Solving one(box_of_bands({0.5}, {1}), settings(64));
    EXPECT_EQ(plan_bands(grey.mesh).solved, std::vector<SolvedBand>{{0}});
    EXPECT_EQ(grey.solver.device_bytes(), one.solver.device_bytes());

    grey.solver.solve(go_on);
    one.solver.solve(go_on);

    const Solution solution = grey.solver.solution();
    for (std::size_t band = 0; band < 3; ++band)
        EXPECT_EQ(solution.irradiance[band], one.solver.solution().irradiance[0]);
}

TEST(Bands, OfProportionalEmissionAreSolvedOnceAndScaled) {
    Solving run(box_of_bands({0.5, 0.5, 0.4}, {1, 4, 1}), exact_settings(1e-6));
    const BandPlan plan = plan_bands(run.mesh);
    EXPECT_EQ(plan.solved, (std::vector<SolvedBand>{{0}, {2}}));
    EXPECT_EQ(plan.solution, (std::vector<std::vector<std::size_t>>{{0, 0, 1}}));

    run.solver.solve(go_on);

    const Solution solution = run.solver.solution();
    for (std::size_t patch = 0; patch < 6; ++patch) {
        EXPECT_EQ(solution.irradiance[1][patch], 4 * solution.irradiance[0][patch]);
        EXPECT_NEAR(solution.radiosity[1][patch], std::numbers::pi * 8, 1e-4);
        EXPECT_NEAR(solution.radiosity[2][patch], std::numbers::pi / 0.6, 1e-4);
    }
    for (const auto& ledger : solution.ledger) EXPECT_LT(ledger.residual(), 1e-5);
}

void expect_finite(const Solution& solution) {
    for (std::size_t band = 0; band < solution.bands.size(); ++band) {
        for (const double value : solution.irradiance[band])
            EXPECT_TRUE(std::isfinite(value) && value >= 0);
        EXPECT_LT(solution.ledger[band].residual(), 1e-5);
    }
}

TEST(Numbers, OfVeryWeakAndVeryStrongLightsAreFinite) {
    Mesh mesh = mesh_of(box({1, 1, 1}, 1), 0.5, 0);
    mesh.materials.push_back({"weak", {0.5}, {1e-30}, false});
    mesh.materials.push_back({"strong", {0.5}, {1e30}, false});
    mesh.surfaces[0].material = 1;
    mesh.surfaces[1].material = 2;
    Solving both(mesh, settings(64, 1e-5));
    mesh.materials[2].emission = {1e-30};
    Solving weak(mesh, settings(64, 1e-5));

    EXPECT_EQ(both.solver.solve(go_on), Stop::converged);
    EXPECT_EQ(weak.solver.solve(go_on), Stop::converged);

    expect_finite(both.solver.solution());
    expect_finite(weak.solver.solution());
    // All light ends in the walls: rho = 0.5, so their flux in all is twice what is emitted.
    const Solution solution = weak.solver.solution();
    double total = 0;
    for (const double value : solution.irradiance[0]) total += value;
    EXPECT_NEAR(total / (2 * 2 * std::numbers::pi * 1e-30), 1, 1e-4);
}

TEST(Numbers, DoNotDependOnTheSizeOfTheWorld) {
    const auto how = settings(128, 1e-3);
    const Solution metres = solution_of(meshed(furnished_room(), 0.75), how);
    for (const double factor : {1e-6, 1e6}) {
        const Mesh mesh = meshed(scaled(furnished_room(), factor), 0.75 * factor);
        const Solution other = solution_of(mesh, how);
        expect_finite(other);
        ASSERT_EQ(other.irradiance[0].size(), metres.irradiance[0].size()) << factor;
        for (std::size_t band = 0; band < 3; ++band) {
            double mean = 0, other_mean = 0;
            for (const double value : metres.irradiance[band]) mean += value;
            for (const double value : other.irradiance[band]) other_mean += value;
            EXPECT_NEAR(other_mean / mean, 1, 1e-3) << factor;
        }
        EXPECT_EQ(other.ledger[0].escaped, 0);
    }
}

TEST(Numbers, OfAFarAwaySceneAreRightOrAnError) {
    const auto how = settings(128, 1e-2);
    const double size = 6;
    for (const double distance : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e15}) try {
            const Mesh mesh = meshed(moved(furnished_room(), glm::dvec3(distance * size)), 0.75);
            const Solution solution = solution_of(mesh, how);
            expect_finite(solution);
            EXPECT_EQ(solution.ledger[0].escaped, 0) << distance;
            EXPECT_NEAR(solution.ledger[0].emitted / (10 * std::numbers::pi), 1, 0.05) << distance;
            EXPECT_LE(distance, 1e5);
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("precision"), std::string::npos);
            EXPECT_GE(distance, 1e4);
        }
}

}  // namespace
}  // namespace hemirad::test::stopping_test
