#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightmap/rasterize.h"
#include "solver/support.h"

// A closed box whose walls are all alike: B = E / (1 - rho) everywhere. With one hemisphere a patch
// that holds exactly where every patch sees the same, as in a cube of one or 2 x 2 patches a wall.
namespace hemirad::test::furnace_test {
namespace {

struct Furnace {
    double reflectance;
    int cells;  ///< along a wall's edge
};

std::ostream& operator<<(std::ostream& out, const Furnace& furnace) {
    return out << "rho " << furnace.reflectance << ", " << furnace.cells << " cells";
}

Mesh mesh_of(const Furnace& furnace) {
    Scene scene = scene_named("furnace.obj");
    for (auto& material : scene.materials) material.reflectance.assign(3, furnace.reflectance);
    return meshed(scene, 1.0 / furnace.cells);
}

class FurnaceBox : public testing::TestWithParam<Furnace> {};

INSTANTIATE_TEST_SUITE_P(Walls, FurnaceBox,
                         testing::Values(Furnace{0, 1}, Furnace{0.5, 1}, Furnace{0.9, 1},
                                         Furnace{0.99, 1}, Furnace{0, 2}, Furnace{0.5, 2},
                                         Furnace{0.9, 2}, Furnace{0.99, 2}));

TEST_P(FurnaceBox, IsEquallyBrightEverywhere) {
    const Mesh mesh = mesh_of(GetParam());
    ASSERT_EQ(mesh.patches.size(),
              static_cast<std::size_t>(6 * GetParam().cells * GetParam().cells));
    const double radiosity = std::numbers::pi / (1 - GetParam().reflectance);

    const Solution solution = solution_of(mesh, settings(512, 1e-5));

    EXPECT_TRUE(solution.converged);
    for (const auto& band : solution.radiosity)
        for (const double value : band) EXPECT_NEAR(value / radiosity, 1, 1e-3);
    const auto layout = lay_out_charts(mesh);
    // Gutters included.
    const auto is_within_a_chart = [&](std::size_t texel) {
        const auto x = static_cast<std::int64_t>(texel % layout.atlases[0].width);
        const auto y = static_cast<std::int64_t>(texel / layout.atlases[0].width);
        return std::ranges::any_of(layout.charts, [&](const Chart& chart) {
            const std::int64_t gutter = layout.padding, left = chart.x, top = chart.y;
            return x >= left - gutter && x < left + chart.width + gutter && y >= top - gutter &&
                   y < top + chart.height + gutter;
        });
    };
    for (const auto quantity : {Quantity::irradiance, Quantity::radiosity}) {
        const Lightmap lightmap = rasterize(mesh, solution, layout, quantity);
        std::size_t covered = 0;
        for (const auto& band : lightmap.values)
            for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel) {
                if (lightmap.coverage[texel] > 0) ++covered;
                if (!is_within_a_chart(texel)) continue;
                EXPECT_NEAR(band[texel] / radiosity, 1, 1e-3) << "texel " << texel;
            }
        EXPECT_GE(covered, 3 * mesh.patches.size());
    }
}

TEST(FurnaceBoxOfAnyMesh, KeepsItsMeanBrightness) {
    const Mesh mesh = mesh_of({0.5, 4});

    const Solution solution = solution_of(mesh, settings(128, 1e-5));

    // Rows of the matrix sum up to 1 whatever its columns do, and all patches have one area.
    double mean = 0;
    for (const double value : solution.radiosity[0])
        mean += value / static_cast<double>(mesh.patches.size());
    EXPECT_NEAR(mean / (2 * std::numbers::pi), 1, 2e-5);
}

}  // namespace
}  // namespace hemirad::test::furnace_test
