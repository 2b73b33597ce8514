#include <gtest/gtest.h>

#include <numbers>

#include "solver/lightmap_bytes.h"
#include "solver/support.h"

// --form-factor analytic: closed forms times visible fractions, in whole solves.
namespace hemirad::test::analytic_test {
namespace {

SolverSettings analytic(std::uint32_t resolution, double tolerance, double sampling_error = 1e-3) {
    SolverSettings result = settings(resolution, tolerance);
    result.form_factor = FormFactorMode::analytic;
    result.sampling_error = sampling_error;
    return result;
}

Mesh furnace(double reflectance, int cells) {
    Scene scene = scene_named("furnace.obj");
    for (auto& material : scene.materials) material.reflectance.assign(3, reflectance);
    return meshed(scene, 1.0 / cells);
}

// With closed forms for all pairs, one hemisphere a patch is enough for any mesh.
TEST(Analytic, AFurnaceOfAFineMeshIsEquallyBrightEverywhere) {
    for (const double reflectance : {0.5, 0.99}) {
        const double radiosity = std::numbers::pi / (1 - reflectance);

        const Solution solution = solution_of(furnace(reflectance, 4), analytic(128, 1e-4, 1e-6));

        // Tolerance apart, which leaves the same part of the emitted flux unshot everywhere.
        for (const auto& band : solution.radiosity)
            for (const double value : band) EXPECT_NEAR(value / radiosity, 1, 3e-4);
    }
}

TEST(Analytic, NothingHidesTheWallsOfAnEmptyRoomFromAPlaneOfFewProxels) {
    const Mesh mesh = meshed(scene_named("furnace.obj"), 0.25);

    const Solution coarse = solution_of(mesh, analytic(64, 1e-3));
    const Solution fine = solution_of(mesh, analytic(512, 1e-3));

    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
        EXPECT_NEAR(coarse.irradiance[0][i] / fine.irradiance[0][i], 1, 1e-3);
}

// Where neighbours both claim a proxel at their edge, the one that does not get it is not hidden.
TEST(Analytic, NothingHidesAnyPatchOfAConvexRoom) {
    std::mt19937 random(41);
    PipelineSettings analytic_factors;
    analytic_factors.form_factor = FormFactorMode::analytic;
    for (int turn = 0; turn < 4; ++turn) {
        auto walls = box({1, 0.7, 0.5}, 8);
        const auto rotation = random_rotation(random);
        for (auto& wall : walls)
            for (auto& corner : wall.corners) corner = rotation * corner;
        Aimed aimed(walls, shapes()[turn % 3], 256, analytic_factors);
        const std::size_t stride = aimed.pipeline().stride();
        for (int shooter = 0; shooter < static_cast<int>(walls.size()); shooter += 5) {
            aimed.aim(shooter);
            aimed.project();

            const auto factors = aimed.pipeline().factors();

            for (std::size_t patch = 0; patch < walls.size(); ++patch)
                ASSERT_EQ(factors[kVisibleFactor * stride + patch],
                          factors[kUnblockedFactor * stride + patch])
                    << "from " << shooter << " to " << patch;
            aimed.pipeline().clear_counts();
        }
    }
}

TEST(Analytic, TheLedgerCloses) {
    for (const char* const name : {"hall2k.obj", "squares.obj", "lroom.obj", "cornell.gltf"}) {
        const auto how = [&] {
            auto result = analytic(128, 1e-2);
            result.max_shots = 500;
            return result;
        }();
        const Solution solution = solution_of(meshed(scene_named(name), 0.5), how);

        for (const auto& ledger : solution.ledger) EXPECT_LT(ledger.residual(), 1e-5) << name;
    }
}

TEST(Analytic, ClosureOfTheProxelsIsStillExact) {
    const Mesh mesh = meshed(scene_named("squares.obj"), 0.25);
    const auto device = mp1map::Device::open("");
    auto how = analytic(64, 1e-2);
    how.shooter_samples = 2;
    ProgressiveSolver solver(mesh, how, device);

    solver.solve(go_on);

    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
}

TEST(Analytic, TheLightmapHasTheSameBitsOnEveryMachine) {
    auto how = analytic(150, 1e-3);
    how.shooter_samples = 2;
    how.max_shots = 40;
    mp1map::PeArrayRequest block{16, 16, 4, 0, 0};
    block.layout = mp1map::Layout::block;

    expect_same_bytes(meshed(scene_named("hall2k.obj"), 0), how,
                      {{"default", {}},
                       {"lanes 1", {0, 0, 1, 0, 0}},
                       {"lanes 8", {0, 0, 8, 0, 0}},
                       {"16x16 PEs, lanes 4, block", block},
                       {"1 compute unit", {}, 1},
                       {"again", {}}});
}

TEST(Analytic, AndWhateverThePowerOfTwoTheSceneIsScaledBy) {
    const auto how = analytic(64, 1e-2);
    const Solution whole = solution_of(meshed(furnished_room(), 0.75), how);

    for (const double factor : {0x1p-20, 2.0})
        EXPECT_EQ(
            solution_of(meshed(scaled(furnished_room(), factor), 0.75 * factor), how).irradiance,
            whole.irradiance)
            << factor;
}

}  // namespace
}  // namespace hemirad::test::analytic_test
