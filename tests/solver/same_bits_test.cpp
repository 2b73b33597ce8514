#include <gtest/gtest.h>

#include <cmath>

#include "solver/lightmap_bytes.h"
#include "solver/support.h"

// The lightmap is the same to the last bit whatever the PE array, its lanes, its tiles and the
// device's compute units.
namespace hemirad::test::same_bits_test {
namespace {

std::vector<Machine> machines() {
    return {{"default", {}},
            {"lanes 1", {0, 0, 1, 0, 0}},
            {"lanes 8", {0, 0, 8, 0, 0}},
            {"16x16 PEs, lanes 4", {16, 16, 4, 0, 0}},
            {"64x64 PEs", {64, 64, 1, 0, 0}},
            {"1 compute unit", {}, 1},
            {"again", {}}};
}

TEST(SameBits, OfTheCornellBoxOnEveryMachine) {
    expect_same_bytes(meshed(scene_named("cornell.gltf"), 0.06), settings(150, 1e-3, 150),
                      machines());
}

TEST(SameBits, OfTheSmallHallOnEveryMachine) {
    auto how = settings(150, 1e-3, 40);
    how.shooter_samples = 2;
    expect_same_bytes(meshed(scene_named("hall2k.obj"), 0), how, machines());
}

TEST(SameBits, WhateverTheIntervalsOfTheHost) {
    const Mesh mesh = meshed(furnished_room(), 0.75);
    const auto how = settings(128, 1e-2);
    const Solution whole = solution_of(mesh, how);
    const auto device = mp1map::Device::open("");

    for (const std::uint64_t every : {1u, 3u, 50u}) {
        SolverSettings in_steps = how;
        in_steps.stop_every = {every};
        ProgressiveSolver solver(mesh, in_steps, device);
        while (solver.solve([](const Progress&) { return false; }) == Stop::interrupted) {
        }
        EXPECT_EQ(solver.solution().irradiance, whole.irradiance) << "every " << every;
        EXPECT_EQ(solver.solution().shots, whole.shots);
    }
}

TEST(SameBits, WhateverThePowerOfTwoTheSceneIsScaledBy) {
    std::mt19937 random(6);
    const Scene scene = rotated(furnished_room(), random_rotation(random));
    const auto how = settings(128, 1e-2);
    const Solution whole = solution_of(meshed(scene, 0.75), how);

    for (const double factor : {0x1p-20, 0.5, 2.0, 0x1p20}) {
        const Solution other = solution_of(meshed(scaled(scene, factor), 0.75 * factor), how);
        EXPECT_EQ(other.irradiance, whole.irradiance) << factor;
        EXPECT_EQ(other.shots, whole.shots);
    }
}

// Half of the extent is about a power of two: differences of coordinates must not reach 2^31.
TEST(SameBits, OfGridCoordinatesWhateverThePowerOfTwo) {
    for (const double edge :
         {std::nextafter(2.0, 1.0), 2 - 0x1p-31, 2.0, std::nextafter(2.0, 3.0)}) {
        Mesh mesh =
            mesh_of(std::vector<Polygon>{{{glm::dvec3(0), {edge, 0, 0}, {edge, 1, 0}, {0, 1, 0}}}});
        const auto arrays = patch_arrays(mesh);
        for (auto& vertex : mesh.vertices) vertex *= 1024.0;

        const auto scaled_arrays = patch_arrays(mesh);

        EXPECT_EQ(scaled_arrays.corners, arrays.corners);
        EXPECT_EQ(scaled_arrays.scale * 1024, arrays.scale);
        EXPECT_LT(*std::ranges::max_element(arrays.corners), 1 << 30) << edge;
        EXPECT_GE(*std::ranges::max_element(arrays.corners), (1 << 29) - 1) << edge;
    }
}

}  // namespace
}  // namespace hemirad::test::same_bits_test
