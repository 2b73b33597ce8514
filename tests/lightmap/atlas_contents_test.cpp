#include "lightmap/atlas_contents.h"

#include <cmath>

#include "lightmap/support.h"

namespace hemirad::atlas_contents_test {
namespace {

using Objects = std::vector<std::uint32_t>;

/// A square metre of its own object at each x, where `uvs` are given with these in the lightmap.
Scene squares(const std::vector<double>& at, const std::vector<std::vector<glm::dvec2>>& uvs = {}) {
    Scene scene;
    scene.file = "hand.gltf";
    scene.bands = {"Y"};
    scene.materials = {{"grey", {0.5}, {1.0}}};
    for (std::uint32_t i = 0; i < at.size(); ++i) {
        const double x = at[i];
        scene.objects.push_back("square" + std::to_string(i));
        for (const glm::dvec3& corner : {glm::dvec3(x, 0, 0), glm::dvec3(x + 1, 0, 0),
                                         glm::dvec3(x + 1, 1, 0), glm::dvec3(x, 1, 0)})
            scene.positions.push_back(corner);
        const std::uint32_t first = 4 * i;
        scene.faces.push_back({{first, first + 1, first + 2, first + 3}, 0, i});
        if (i < uvs.size()) scene.faces.back().lightmap_uvs = uvs[i];
    }
    return scene;
}

std::vector<AtlasContents> contents_of(const Scene& scene, const ChartSettings& settings) {
    const Mesh mesh = build_mesh(scene, {.patch_size = 0.5, .backfaces = Backfaces::cull});
    return atlas_contents(scene, mesh, lay_out_charts(scene, mesh, settings));
}

TEST(AtlasContents, AreThoseOfItsCharts) {
    const auto atlases = contents_of(squares({0, 2}), {.texel_size = 0.125, .padding = 2});

    ASSERT_EQ(atlases.size(), 1u);
    EXPECT_EQ(atlases[0].chart_count, 2u);
    EXPECT_NEAR(atlases[0].filled, 2 * 8 * 8, 1e-9);
    EXPECT_NEAR(atlases[0].texel_size, 0.125, 1e-12);
    EXPECT_EQ(atlases[0].objects, (Objects{0, 1}));
    EXPECT_GE(atlases[0].width * atlases[0].height, 2u * 12 * 12);
}

TEST(AtlasContents, BacksAreChartsToo) {
    Scene scene = squares({0});
    scene.materials[0].double_sided = true;

    const auto atlases = contents_of(scene, {.texel_size = 0.125});

    EXPECT_EQ(atlases[0].chart_count, 2u);
    EXPECT_NEAR(atlases[0].filled, 2 * 8 * 8, 1e-9);
    EXPECT_EQ(atlases[0].objects, (Objects{0}));
}

TEST(AtlasContents, TellWhichObjectIsWhere) {
    const auto atlases =
        contents_of(squares({0, 2}), {.texel_size = 0.125, .padding = 2, .atlas_size = 12});

    ASSERT_EQ(atlases.size(), 2u);
    EXPECT_EQ(atlases[0].objects, (Objects{0}));
    EXPECT_EQ(atlases[1].objects, (Objects{1}));
}

/// From the top left corner on, V down.
std::vector<glm::dvec2> square_uvs(double u, double v, double side) {
    return {{u, v + side}, {u + side, v + side}, {u + side, v}, {u, v}};
}

TEST(AtlasContents, OfAScenesOwnUvsAreItsConnectedPieces) {
    const auto atlases = contents_of(
        squares({0, 2}, {square_uvs(0, 0, 0.5), square_uvs(0.5, 0.5, 0.25)}), {.atlas_size = 16});

    ASSERT_EQ(atlases.size(), 1u);
    EXPECT_EQ(atlases[0].chart_count, 2u);  // though they meet in a corner: of two objects
    EXPECT_NEAR(atlases[0].filled, 64 + 16, 1e-9);
    EXPECT_NEAR(atlases[0].texel_size, std::sqrt(2.0 / 80), 1e-12);
}

TEST(AtlasContents, OfOneObjectThatIsCutIntoTwoPiecesAreTwoCharts) {
    Scene scene = squares({0, 1}, {square_uvs(0, 0, 0.25), square_uvs(0.5, 0.5, 0.25)});
    scene.faces[1].object = 0;

    EXPECT_EQ(contents_of(scene, {.atlas_size = 16})[0].chart_count, 2u);
    scene.faces[1].lightmap_uvs = square_uvs(0.25, 0, 0.25);
    EXPECT_EQ(contents_of(scene, {.atlas_size = 16})[0].chart_count, 1u);
}

TEST(AtlasContents, OfAnEmptyAtlasAreNothing) {
    const Scene scene = squares({0});
    const Mesh mesh = build_mesh(scene, {.patch_size = 0.5});
    ChartLayout layout;
    layout.atlases = {{1, 1}};

    const auto atlases = atlas_contents(scene, mesh, layout);

    EXPECT_EQ(atlases[0].objects, Objects{});
    EXPECT_EQ(atlases[0].texel_size, 0);
}

}  // namespace
}  // namespace hemirad::atlas_contents_test
