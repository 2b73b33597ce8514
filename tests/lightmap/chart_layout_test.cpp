#include "lightmap/chart_layout.h"

#include <cmath>
#include <limits>

#include "errors.h"
#include "lightmap/support.h"

namespace hemirad::chart_layout_test {
namespace {

Mesh mesh_of_many_sizes() {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 200; ++i)
        add_surface(mesh, 1 + i * 7 % 13, 1 + i * 5 % 11, {1, 1});
    return mesh;
}

bool same_place(const Chart& a, const Chart& b) {
    return a.surface == b.surface && a.x == b.x && a.y == b.y && a.width == b.width &&
           a.height == b.height;
}

TEST(ChartLayout, ChartsWithTheirPaddingDoNotOverlap) {
    const auto layout = lay_out_charts(mesh_of_many_sizes(), {.texel_size = 0.5, .padding = 3});

    std::vector<int> owner_count(std::size_t{layout.atlases[0].width} * layout.atlases[0].height);
    for (const Chart& chart : layout.charts) {
        ASSERT_GE(chart.x, 3u);
        ASSERT_GE(chart.y, 3u);
        ASSERT_LE(chart.x + chart.width + 3, layout.atlases[0].width);
        ASSERT_LE(chart.y + chart.height + 3, layout.atlases[0].height);
        for (auto y = chart.y - 3; y < chart.y + chart.height + 3; ++y) {
            for (auto x = chart.x - 3; x < chart.x + chart.width + 3; ++x) {
                ++owner_count[std::size_t{y} * layout.atlases[0].width + x];
            }
        }
    }
    EXPECT_EQ(*std::max_element(owner_count.begin(), owner_count.end()), 1);
}

TEST(ChartLayout, AtlasIsNearlySquareAndNearlyFull) {
    const auto layout = lay_out_charts(mesh_of_many_sizes(), {.texel_size = 0.25, .padding = 2});

    double area = 0;
    for (const Chart& chart : layout.charts) area += (chart.width + 4.0) * (chart.height + 4.0);
    EXPECT_NEAR(double(layout.atlases[0].height) / layout.atlases[0].width, 1.0, 0.06);
    EXPECT_GT(area / (double(layout.atlases[0].width) * layout.atlases[0].height), 0.85);
}

TEST(ChartLayout, SameMeshGivesSameLayout) {
    const auto first = lay_out_charts(mesh_of_many_sizes());
    const auto second = lay_out_charts(mesh_of_many_sizes());

    EXPECT_TRUE(std::equal(first.charts.begin(), first.charts.end(), second.charts.begin(),
                           second.charts.end(), same_place));
}

TEST(ChartLayout, WholeTexelsFillTheGridAndAreNoLargerThanAsked) {
    const auto layout = lay_out_charts(rectangle(2, 3, {1.0, 0.35}), {.texel_size = 0.3});

    ASSERT_EQ(layout.charts.size(), 1u);
    EXPECT_EQ(layout.charts[0].width, 7u);
    EXPECT_EQ(layout.charts[0].height, 4u);
    EXPECT_DOUBLE_EQ(layout.charts[0].texel_size.x, 2.0 / 7);
    EXPECT_DOUBLE_EQ(layout.charts[0].texel_size.y, 1.05 / 4);
}

TEST(ChartLayout, RoundingAddsNoTexel) {
    const auto layout = lay_out_charts(rectangle(1, 1, {0.3, 2.1}), {.texel_size = 0.1});

    EXPECT_EQ(layout.charts[0].width, 3u);
    EXPECT_EQ(layout.charts[0].height, 21u);
}

TEST(ChartLayout, DefaultTexelIsHalfTheShorterCellEdgeButOfWhatIsSmallInAll) {
    Mesh mesh;
    add_surface(mesh, 1, 1, {0.01, 0.02});
    add_surface(mesh, 1, 1, {5.0, 0.4});
    add_surface(mesh, 2, 1, {7.0, 1.0});
    EXPECT_DOUBLE_EQ(default_texel_size(mesh), 0.2);

    add_surface(mesh, 100, 100, {0.03, 0.05});
    EXPECT_DOUBLE_EQ(default_texel_size(mesh), 0.015);
}

TEST(ChartLayout, DefaultTexelAlwaysFitsTheAtlas) {
    Mesh mesh;
    add_surface(mesh, 1'000'000, 1'000'000, {0.01, 0.01});

    EXPECT_NO_THROW(lay_out_charts(mesh));
}

TEST(ChartLayout, SurfacesWithoutAChartAreLeftOut) {
    Mesh mesh = rectangle(1, 1);
    add_rectangle(mesh, 1, 1);
    mesh.surfaces[0].has_chart = false;

    const auto layout = lay_out_charts(mesh);

    ASSERT_EQ(layout.charts.size(), 1u);
    EXPECT_EQ(layout.charts[0].surface, 1u);
}

TEST(ChartLayout, ChartShowsTheSurfaceAsSeenFromItsFront) {
    const Mesh mesh = rectangle(4, 2);
    const Chart chart{0, 0, 10, 20, 8, 4, {0.5, 0.5}};

    EXPECT_EQ(atlas_from_world(chart, mesh.surfaces[0], {0, 0, 0}), glm::dvec2(10, 24));
    EXPECT_EQ(atlas_from_world(chart, mesh.surfaces[0], {4, 2, 0}), glm::dvec2(18, 20));
}

TEST(ChartLayout, TooSmallATexelIsRefusedWithASizeThatWorks) {
    const Mesh mesh = rectangle(100, 100);

    const auto message =
        message_of<InputError>([&] { lay_out_charts(mesh, {.texel_size = 0.001}); });

    EXPECT_EQ(message,
              "--texel-size 0.001: the chart of a surface takes 1e+05 x 1e+05 texels, an atlas of "
              "16384 has room for 1.64e+04 a side; try --texel-size 0.00617");
    EXPECT_NO_THROW(lay_out_charts(mesh, {.texel_size = 0.00617}));
}

TEST(ChartLayout, ManyChartsThatExceedTheAtlasTogetherAreRefused) {
    Mesh mesh;
    for (int i = 0; i < 10; ++i) add_surface(mesh, 1, 1, {100, 100});

    EXPECT_THROW(lay_out_charts(mesh, {.texel_size = 0.01}), InputError);
}

TEST(ChartLayout, ChartsThatOneAtlasDoesNotHoldFillSeveral) {
    const auto layout =
        lay_out_charts(mesh_of_many_sizes(), {.texel_size = 0.5, .padding = 3, .atlas_size = 64});

    ASSERT_GT(layout.atlases.size(), 2u);
    std::vector<std::vector<int>> owner_count;
    for (const Atlas& atlas : layout.atlases) {
        EXPECT_LE(std::max(atlas.width, atlas.height), 64u);
        owner_count.emplace_back(std::size_t{atlas.width} * atlas.height);
    }
    for (const Chart& chart : layout.charts)
        for (auto y = chart.y - 3; y < chart.y + chart.height + 3; ++y)
            for (auto x = chart.x - 3; x < chart.x + chart.width + 3; ++x) {
                ASSERT_LT(x, layout.atlases[chart.atlas].width);
                ASSERT_LT(y, layout.atlases[chart.atlas].height);
                EXPECT_EQ(++owner_count[chart.atlas][y * layout.atlases[chart.atlas].width + x], 1);
            }
}

TEST(ChartLayout, AChartThatIsLargerThanTheAtlasIsRefusedByName) {
    Mesh mesh = rectangle(8, 8);
    mesh.objects = {"hall"};

    const auto message = message_of<InputError>(
        [&] { lay_out_charts(mesh, {.texel_size = 0.1, .padding = 2, .atlas_size = 64}); });

    EXPECT_EQ(
        message,
        "--texel-size 0.1: the chart of \"hall\" takes 80 x 80 texels, an atlas of 64 has room "
        "for 60 a side; try --texel-size 0.135");
    EXPECT_NO_THROW(lay_out_charts(mesh, {.texel_size = 0.135, .padding = 2, .atlas_size = 64}));
}

TEST(ChartLayout, TexelSizeMustBeAPositiveNumber) {
    const Mesh mesh = rectangle(1, 1);

    EXPECT_THROW(lay_out_charts(mesh, {.texel_size = -1.0}), InputError);
    EXPECT_THROW(lay_out_charts(mesh, {.texel_size = std::nan("")}), InputError);
    EXPECT_THROW(lay_out_charts(mesh, {.texel_size = std::numeric_limits<double>::infinity()}),
                 InputError);
}

}  // namespace
}  // namespace hemirad::chart_layout_test
