#pragma once

#include <numbers>

#include "extremes/solves_support.h"
#include "reference/closed_forms.h"

/// A square lamp 1 m above a square floor, both black, so that one shot is the whole solution and
/// closed forms say what it is.
namespace hemirad::test {

using Corners = std::vector<glm::dvec3>;

inline const Corners kFloor = rectangle(0, 0, 1, 1);
inline const Corners kLamp = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};

/// The floor in strips of `columns` x `rows` quads, each a patch of its own.
inline Mesh lamp_above_floor(int columns, int rows) {
    Scene scene = empty_scene();
    scene.materials = {{"black", {0}, {0}, false}, {"lamp", {0}, {1}, false}};
    add_face(scene, kLamp, 1);
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            add_face(scene, rectangle(1.0 * column / columns, 1.0 * row / rows,
                                      (column + 1.0) / columns, (row + 1.0) / rows));
    return mesh_of(scene, kUncut);
}

/// Of the points from which a patch shoots, the centres of samples x samples cells.
inline double from_the_lamps_points(int samples) {
    double sum = 0;
    for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j)
            sum += reference::point_to_polygon({(i + 0.5) / samples, (j + 0.5) / samples, 1},
                                               {0, 0, -1}, kFloor);
    return sum / (samples * samples);
}

inline double received_by_the_floor(const Mesh& mesh, const Solution& solution) {
    double flux = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
        flux += mesh.area(mesh.patches[i]) * solution.irradiance[0][i];
    return flux / solution.ledger[0].emitted;
}

/// Floats: a factor, its product with the flux, and the sums of a row of closed forms by blocks.
inline constexpr double kRounding = 4 * 0x1p-24;

/// Proxels that the outline of the floor cuts may be counted as in or out. Its projection is convex
/// and lies in the disk, so it is no longer than the disk's own outline, pi / 2 of N x 2 proxels.
inline double cut_share(std::uint32_t resolution) {
    const double cut = std::numbers::pi * resolution * std::numbers::sqrt2;
    return cut / static_cast<double>(disk_proxel_count(resolution));
}

inline void expect_one_shot(const Mesh& mesh, const SolverSettings& how) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    EXPECT_EQ(solver.solve(go_on), Stop::converged);
    const Solution solution = solver.solution();

    expect_numbers(solution);
    EXPECT_EQ(solution.shots, 1u);
    EXPECT_EQ(solver.closure().least, 1);
    EXPECT_EQ(solver.closure().most, 1);
    EXPECT_LT(largest_residual(solution), kRounding);
    const double received = received_by_the_floor(mesh, solution);
    if (how.form_factor == FormFactorMode::count)
        EXPECT_NEAR(received, from_the_lamps_points(static_cast<int>(how.shooter_samples)),
                    cut_share(how.resolution));
    else
        EXPECT_NEAR(received, reference::parallel_rectangles(1, 1, 1), how.sampling_error);
    testing::Test::RecordProperty("device_MiB", std::to_string(solver.device_bytes() >> 20));
}

inline SolverSettings one_shot(FormFactorMode mode, std::uint32_t resolution,
                               std::uint32_t samples = 1) {
    auto result = settings(resolution, mode, 1e-3);
    result.shooter_samples = samples;
    return result;
}

}  // namespace hemirad::test
