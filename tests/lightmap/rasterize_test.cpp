#include "lightmap/rasterize.h"

#include <numeric>

#include "lightmap/support.h"

namespace hemirad::rasterize_test {
namespace {

/// Three of four cells, and in the corner of the fourth a triangle: half a cell.
Mesh notched_mesh() {
    Mesh mesh;
    mesh.bands = {"Y"};
    add_surface(mesh, 2, 2, {1, 1});
    add_whole_cell(mesh, 0, 0);
    add_whole_cell(mesh, 1, 0);
    add_whole_cell(mesh, 0, 1);
    add_patch(mesh, 3, {{1, 1}, {2, 1}, {1, 2}});
    return mesh;
}

Lightmap rasterized(const Mesh& mesh, const Solution& solution, double texel_size) {
    return rasterize(mesh, solution, lay_out_charts(mesh, {.texel_size = texel_size, .padding = 2}),
                     Quantity::irradiance);
}

double covered_area(const Lightmap& lightmap) {
    return std::accumulate(lightmap.coverage.begin(), lightmap.coverage.end(), 0.0);
}

TEST(Rasterize, AConstantSolutionGivesExactlyConstantTexelsAndGutters) {
    Mesh mesh = notched_mesh();
    for (auto& vertex : mesh.vertices) vertex *= 1.0 / 3;
    mesh.surfaces[0].cell_size /= 3;

    const auto lightmap = rasterized(mesh, constant_solution(mesh, 0.7), 0.06);

    const auto layout = lay_out_charts(mesh, {.texel_size = 0.06, .padding = 2});
    const Chart& chart = layout.charts[0];
    for (std::size_t i = 0; i < lightmap.texel_count(); ++i) {
        if (lightmap.coverage[i] == 0.0f) continue;
        EXPECT_EQ(lightmap.values[0][i], 0.7f);
    }
    for (std::uint32_t x = chart.x - 2; x < chart.x + chart.width + 2; ++x) {
        for (std::uint32_t row = 1; row <= 2; ++row) {
            const auto below = texel_at(lightmap, x, chart.y + chart.height - 1 + row);
            EXPECT_EQ(lightmap.values[0][below], 0.7f);
            EXPECT_EQ(lightmap.coverage[below], 0.0f);
        }
    }
}

TEST(Rasterize, ALinearRampStaysLinearBetweenTheCellCentres) {
    const Mesh mesh = rectangle(4, 3);
    std::vector<double> ramp;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) ramp.push_back(10.0 + 2 * column + 5 * row);
    }

    const auto lightmap = rasterized(mesh, solution_of(ramp), 0.25);

    for (std::uint32_t y = 2; y < 10; ++y) {
        for (std::uint32_t x = 2; x < 14; ++x) {
            const double s = (x + 0.5) / 4, t = (12 - y - 0.5) / 4;
            EXPECT_FLOAT_EQ(lightmap.values[0][texel_at(lightmap, x + 2, y + 2)],
                            static_cast<float>(10.0 + 2 * (s - 0.5) + 5 * (t - 0.5)));
        }
    }
}

TEST(Rasterize, BeyondTheOutermostCellCentresTheValueStaysConstant) {
    const Mesh mesh = rectangle(2, 1);

    const auto lightmap = rasterized(mesh, solution_of({1.0, 3.0}), 0.25);

    const std::vector<float> expected{1, 1, 1.25, 1.75, 2.25, 2.75, 3, 3};
    for (std::uint32_t x = 0; x < 8; ++x) {
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, x + 2, 3)], expected[x]);
    }
}

TEST(Rasterize, ACellTakesTheAreaWeightedMeanOfItsPatches) {
    Mesh mesh;
    add_surface(mesh, 1, 1, {2, 2});
    add_patch(mesh, 0, {{0, 0}, {0.25, 0}, {0.25, 1}, {0, 1}});
    add_patch(mesh, 0, {{0.25, 0}, {1, 0}, {1, 1}, {0.25, 1}});

    const auto lightmap = rasterized(mesh, solution_of({8.0, 4.0}), 2.0);

    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, 2, 2)], 5.0f);
}

/// Four cells a metre wide side by side; a block stands on x < 1.5, in the dark.
Mesh half_covered_mesh() {
    Mesh mesh;
    mesh.bands = {"Y"};
    add_surface(mesh, 4, 1, {1, 1});
    add_whole_cell(mesh, 0, 0);
    add_patch(mesh, 1, {{1, 0}, {1.5, 0}, {1.5, 1}, {1, 1}});
    add_patch(mesh, 1, {{1.5, 0}, {2, 0}, {2, 1}, {1.5, 1}});
    add_whole_cell(mesh, 2, 0);
    add_whole_cell(mesh, 3, 0);
    mesh.surfaces[0].side_of_patch = {1, 1, 0, 0, 0};
    return mesh;
}

TEST(Rasterize, TexelsTakeTheLightOfTheirOwnSideOfABlock) {
    const Mesh mesh = half_covered_mesh();
    const auto lightmap = rasterized(mesh, solution_of({0, 0, 8, 8, 8}), 0.125);

    const Chart chart = lay_out_charts(mesh, {.texel_size = 0.125, .padding = 2}).charts[0];
    for (std::uint32_t x = 0; x < 32; ++x)
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, chart.x + x, chart.y + 3)],
                  x < 12 ? 0.0f : 8.0f)
            << x;
}

TEST(Rasterize, ATexelOnTheOutlineOfABlockTakesTheSideOfItsLargerPart) {
    const Mesh mesh = half_covered_mesh();
    const auto lightmap = rasterized(mesh, solution_of({0, 0, 8, 8, 8}), 0.4);

    // Of the texel from 1.2 to 1.6 m three quarters are covered.
    const Chart chart = lay_out_charts(mesh, {.texel_size = 0.4, .padding = 2}).charts[0];
    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, chart.x + 3, chart.y)], 0.0f);
    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, chart.x + 4, chart.y)], 8.0f);
}

TEST(Rasterize, CellsWithoutAPatchAreLeftOut) {
    Mesh mesh;
    add_surface(mesh, 3, 1, {1, 1});
    add_whole_cell(mesh, 0, 0);
    add_whole_cell(mesh, 2, 0);

    const auto lightmap = rasterized(mesh, solution_of({1.0, 9.0}), 0.5);

    const std::vector<float> values{1, 1, 1, 9, 9, 9}, coverages{1, 1, 0, 0, 1, 1};
    for (std::uint32_t x = 0; x < 6; ++x) {
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, x + 2, 2)], values[x]);
        EXPECT_EQ(lightmap.coverage[texel_at(lightmap, x + 2, 2)], coverages[x]);
    }
}

TEST(Rasterize, ATexelLargerThanCellsTakesTheCellThatFillsMostOfIt) {
    Mesh mesh;
    add_surface(mesh, 8, 1, {1, 1});
    add_patch(mesh, 0, {{0, 0}, {0.5, 0}, {0.5, 1}, {0, 1}});
    add_whole_cell(mesh, 7, 0);

    const auto lightmap = rasterized(mesh, solution_of({1.0, 9.0}), 8.0);

    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, 2, 2)], 9.0f);
    EXPECT_EQ(lightmap.coverage[texel_at(lightmap, 2, 2)], 1.5f / 8);
}

TEST(Rasterize, CoverageIsTheFractionOfTheTexelInsideTheOutline) {
    const Mesh mesh = notched_mesh();

    const auto lightmap = rasterized(mesh, constant_solution(mesh, 1.0), 0.5);

    const std::vector<float> expected{1, 1, 0.5f, 0,     //
                                      1, 1, 1,    0.5f,  //
                                      1, 1, 1,    1,     //
                                      1, 1, 1,    1};
    for (std::uint32_t i = 0; i < 16; ++i) {
        EXPECT_EQ(lightmap.coverage[texel_at(lightmap, 2 + i % 4, 2 + i / 4)], expected[i]) << i;
    }
}

TEST(Rasterize, CoverageAddsUpToTheAreaForAnyTexelSize) {
    const Mesh mesh = notched_mesh();

    for (const double texel_size : {0.07, 0.3, 0.51, 1.7, 5.0}) {
        const auto layout = lay_out_charts(mesh, {.texel_size = texel_size, .padding = 2});
        const auto lightmap =
            rasterize(mesh, constant_solution(mesh, 1.0), layout, Quantity::irradiance);
        const glm::dvec2 texel = layout.charts[0].texel_size;
        EXPECT_NEAR(covered_area(lightmap) * texel.x * texel.y, 3.5, 1e-5) << texel_size;
    }
}

TEST(Rasterize, AGutterTexelCopiesTheNearestCoveredOneOfItsChart) {
    Mesh mesh = rectangle(2, 2);
    add_rectangle(mesh, 2, 2);
    const auto layout = lay_out_charts(mesh, {.texel_size = 1.0, .padding = 3});

    const auto lightmap =
        rasterize(mesh, solution_of({1, 2, 3, 4, 5, 6, 7, 8}), layout, Quantity::irradiance);

    for (std::uint32_t i = 0; i < 2; ++i) {
        const Chart& chart = layout.charts[i];
        const auto value = [&](std::uint32_t x, std::uint32_t y) {
            return lightmap.values[0][texel_at(lightmap, chart.x + x - 3, chart.y + y - 3)];
        };
        EXPECT_EQ(value(0, 0), 3.0f + 4 * i);
        EXPECT_EQ(value(7, 0), 4.0f + 4 * i);
        EXPECT_EQ(value(0, 7), 1.0f + 4 * i);
        EXPECT_EQ(value(7, 7), 2.0f + 4 * i);
        EXPECT_EQ(value(5, 4), 2.0f + 4 * i);
    }
}

TEST(Rasterize, TheQuantityIsTheOneAskedFor) {
    const Mesh mesh = rectangle(1, 1);
    const auto layout = lay_out_charts(mesh, {.texel_size = 1.0, .padding = 2});

    const auto lightmap =
        rasterize(mesh, constant_solution(mesh, 3.0), layout, Quantity::radiosity);

    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, 2, 2)], 1.5f);
}

TEST(Rasterize, EachBandHasItsOwnTexels) {
    const Mesh mesh = rectangle(1, 1);
    Solution solution;
    solution.bands = {"R", "G"};
    solution.irradiance = {{1.0}, {2.0}};

    const auto lightmap = rasterized(mesh, solution, 1.0);

    EXPECT_EQ(lightmap.bands, solution.bands);
    EXPECT_EQ(lightmap.values[0][texel_at(lightmap, 2, 2)], 1.0f);
    EXPECT_EQ(lightmap.values[1][texel_at(lightmap, 2, 2)], 2.0f);
}

}  // namespace
}  // namespace hemirad::rasterize_test
