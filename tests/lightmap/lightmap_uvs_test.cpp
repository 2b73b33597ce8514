#include "lightmap/lightmap_uvs.h"

#include <glm/geometric.hpp>

#include "lightmap/support.h"

namespace hemirad::lightmap_uvs_test {
namespace {

Scene scene_of(const std::vector<glm::dvec3>& positions,
               const std::vector<std::vector<std::uint32_t>>& faces) {
    Scene scene;
    scene.file = "hand.obj";
    scene.bands = {"Y"};
    scene.positions = positions;
    scene.materials = {{"grey", {0.5}, {1.0}}};
    scene.objects = {"thing"};
    for (const auto& vertices : faces) scene.faces.push_back({vertices, 0, 0});
    return scene;
}

Scene unit_square() {
    return scene_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
}

struct Laid {
    Mesh mesh;
    ChartLayout layout;
};

Laid laid_out(const Scene& scene, Backfaces backfaces = Backfaces::cull) {
    Laid laid;
    laid.mesh = build_mesh(scene, {.patch_size = 0.5, .backfaces = backfaces});
    laid.layout = lay_out_charts(laid.mesh, {.texel_size = 0.125, .padding = 2});
    return laid;
}

std::vector<UvTriangle> uvs_of(const Scene& scene, Backfaces backfaces = Backfaces::cull) {
    const auto [mesh, layout] = laid_out(scene, backfaces);
    return lightmap_uvs(scene, mesh, layout);
}

double area_of(const std::vector<UvTriangle>& triangles) {
    double area = 0;
    for (const UvTriangle& triangle : triangles) {
        const auto& [a, b, c] = triangle.uvs;
        area += std::abs((b - a).x * (c - a).y - (b - a).y * (c - a).x) / 2;
    }
    return area;
}

TEST(LightmapUvs, ASquareIsTwoTrianglesThatFillItsChart) {
    const auto triangles = uvs_of(unit_square());

    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_NEAR(area_of(triangles), 64.0 / 144, 1e-12);  // 8 x 8 of 12 x 12 texels
    for (const UvTriangle& triangle : triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const bool upper = triangle.corners[i] > 1;
            EXPECT_NEAR(triangle.uvs[i].y, upper ? 2.0 / 12 : 10.0 / 12, 1e-12);
        }
}

TEST(LightmapUvs, AConcaveFaceIsCoveredOnceByItsTriangles) {
    const auto triangles = uvs_of(scene_of(
        {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, {{0, 1, 2, 3, 4, 5}}));

    EXPECT_EQ(triangles.size(), 4u);
    EXPECT_NEAR(area_of(triangles), 3.0 * 64 / 400, 1e-12);
}

TEST(LightmapUvs, AWarpedFaceLiesInTwoCharts) {
    const auto triangles =
        uvs_of(scene_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}, {{0, 1, 2, 3}}));

    EXPECT_EQ(triangles.size(), 2u);
    EXPECT_EQ(triangles[0].face, 0u);
    EXPECT_EQ(triangles[1].face, 0u);
}

TEST(LightmapUvs, ADroppedFaceHasNone) {
    Scene scene = unit_square();
    scene.faces.insert(scene.faces.begin(), {{0, 1, 1}, 0, 0});

    const auto triangles = uvs_of(scene);

    ASSERT_EQ(triangles.size(), 2u);
    EXPECT_EQ(triangles[0].face, 1u);
}

TEST(LightmapUvs, ADoubleSidedFaceHasTrianglesOnBothSidesTheBacksTurnedRound) {
    Scene scene = unit_square();
    scene.materials[0].double_sided = true;

    const auto triangles = uvs_of(scene, Backfaces::automatic);

    ASSERT_EQ(triangles.size(), 4u);
    EXPECT_FALSE(triangles[1].is_back);
    EXPECT_TRUE(triangles[2].is_back);
    EXPECT_EQ(triangles[0].corners, (std::array<std::uint32_t, 3>{0, 1, 2}));
    EXPECT_EQ(triangles[2].corners, (std::array<std::uint32_t, 3>{0, 2, 1}));
    // Seen from behind, what is right is left; both sides turn the same way in the atlas.
    EXPECT_LT(triangles[0].uvs[0].x, triangles[0].uvs[1].x);
    EXPECT_GT(triangles[2].uvs[0].x, triangles[2].uvs[2].x);
}

TEST(LightmapUvs, BlackBacksHaveNone) {
    EXPECT_EQ(uvs_of(unit_square(), Backfaces::block).size(), 2u);
}

}  // namespace
}  // namespace hemirad::lightmap_uvs_test
