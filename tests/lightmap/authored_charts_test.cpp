#include <cmath>

#include "errors.h"
#include "lightmap/lightmap_uvs.h"
#include "lightmap/rasterize.h"
#include "lightmap/support.h"
#include "scene/scenes_by_hand.h"
#include "support/peak_memory.h"

// Charts that the scene brings along.
namespace hemirad::authored_charts_test {
namespace {

using Uvs = std::vector<glm::dvec2>;

/// A square's corners in a lightmap, V down: upright, as seen from the front.
const Uvs kWhole{{0, 1}, {1, 1}, {1, 0}, {0, 0}};

Uvs in_part(glm::dvec2 low, glm::dvec2 high) {
    Uvs uvs;
    for (const glm::dvec2& uv : kWhole) uvs.push_back(low + uv * (high - low));
    return uvs;
}

void add_square(Scene& scene, double x, const Uvs& uvs, std::uint32_t object = 0) {
    const auto quad = rectangle(x, 0, x + 1, 1);
    for (const auto& corners : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}}) {
        add_face(scene, {quad[corners[0]], quad[corners[1]], quad[corners[2]]}, 0, object);
        if (uvs.empty()) continue;
        for (const std::uint32_t corner : corners)
            scene.faces.back().lightmap_uvs.push_back(uvs[corner]);
    }
}

Scene square(const Uvs& uvs) {
    Scene scene = empty_scene();
    scene.objects = {"floor", "other"};
    add_square(scene, 0, uvs);
    return scene;
}

struct Laid {
    Mesh mesh;
    ChartLayout layout;
};

Laid laid_out(const Scene& scene, ChartSettings settings = {.atlas_size = 16}) {
    Laid laid{mesh_of(scene, 0.125), {}};
    laid.layout = lay_out_charts(scene, laid.mesh, settings);
    return laid;
}

std::string refusal(const Scene& scene, const ChartSettings& settings = {.atlas_size = 16}) {
    return message_of<InputError>([&] { laid_out(scene, settings); });
}

Lightmap lit_by_x(const Laid& laid) {
    std::vector<double> values;
    for (const Patch& patch : laid.mesh.patches) values.push_back(1 + laid.mesh.centroid(patch).x);
    return rasterize(laid.mesh, solution_of(values), laid.layout, Quantity::irradiance);
}

TEST(AuthoredCharts, ATexelShowsTheLightOfThePlaceThatTheUvsGiveIt) {
    const auto lightmap = lit_by_x(laid_out(square(kWhole)));

    ASSERT_EQ(lightmap.width, 16u);
    for (std::uint32_t y = 0; y < 16; ++y)
        for (std::uint32_t x = 1; x < 15; ++x) {
            EXPECT_FLOAT_EQ(lightmap.values[0][texel_at(lightmap, x, y)], 1 + (x + 0.5f) / 16);
            EXPECT_EQ(lightmap.coverage[texel_at(lightmap, x, y)], 1.0f);
        }
}

TEST(AuthoredCharts, AChartMayBeTurned) {
    Uvs turned = kWhole;
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());  // x runs up

    const auto lightmap = lit_by_x(laid_out(square(turned)));

    for (std::uint32_t y = 1; y < 15; ++y)
        EXPECT_FLOAT_EQ(lightmap.values[0][texel_at(lightmap, 3, y)], 1 + (15.5f - y) / 16);
}

TEST(AuthoredCharts, AnAtlasGetsThePowerOfTwoThatTheTexelSizeAsksFor) {
    const auto [mesh, layout] = laid_out(square(in_part({0, 0}, {0.5, 0.5})), {.texel_size = 0.1});

    ASSERT_EQ(layout.atlases.size(), 1u);
    EXPECT_EQ(layout.atlases[0].width, 32u);  // 20 would do
    EXPECT_TRUE(layout.charts.empty());
}

TEST(AuthoredCharts, GuttersReachAsFarAsThePadding) {
    const auto lightmap = lit_by_x(
        laid_out(square(in_part({0.25, 0.25}, {0.75, 0.75})), {.padding = 3, .atlas_size = 32}));

    for (std::uint32_t x = 0; x < 32; ++x) {
        const bool reached = x >= 5 && x < 27;
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, x, 16)] > 0, reached) << x;
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, x, 26)] > 0, reached) << x;
        EXPECT_EQ(lightmap.values[0][texel_at(lightmap, x, 27)], 0.0f) << x;
    }
}

/// As a renderer filters, at a UV with V down.
double sample(const Lightmap& lightmap, const glm::dvec2& uv) {
    const glm::dvec2 at = uv * glm::dvec2(lightmap.width, lightmap.height) - 0.5;
    const glm::dvec2 low(std::floor(at.x), std::floor(at.y)), part = at - low;
    const auto row = [&](std::uint32_t y) {
        const auto x = static_cast<std::uint32_t>(low.x);
        return lightmap.values[0][texel_at(lightmap, x, y)] * (1 - part.x) +
               lightmap.values[0][texel_at(lightmap, x + 1, y)] * part.x;
    };
    const auto y = static_cast<std::uint32_t>(low.y);
    return row(y) * (1 - part.y) + row(y + 1) * part.y;
}

TEST(AuthoredCharts, TrianglesThatLieApartAgreeAlongTheEdgeTheyShare) {
    Scene scene = square(kWhole);
    Uvs& first = scene.faces[0].lightmap_uvs;   // corners 0, 1, 2
    Uvs& second = scene.faces[1].lightmap_uvs;  // corners 0, 2, 3, of another size and turned
    first = {{0.1, 0.9}, {0.5, 0.9}, {0.5, 0.5}};
    second = {{0.6, 0.1}, {0.8, 0.3}, {0.6, 0.3}};

    const auto lightmap = lit_by_x(laid_out(scene, {.padding = 4, .atlas_size = 64}));

    for (double part = 0.1; part < 0.9; part += 0.01) {
        const double here = sample(lightmap, first[0] + part * (first[2] - first[0]));
        const double there = sample(lightmap, second[0] + part * (second[1] - second[0]));
        EXPECT_NEAR(here / there, 1, 0.005) << part;
    }
}

TEST(AuthoredCharts, TheyComeBackAsTheUvsOfTheirFaces) {
    for (const bool flip_v : {false, true}) {
        const Scene scene = square(in_part({0.25, 0}, {0.75, 0.5}));
        const auto [mesh, layout] = laid_out(scene, {.atlas_size = 16, .flip_v = flip_v});

        const auto triangles = lightmap_uvs(scene, mesh, layout);

        ASSERT_EQ(triangles.size(), 2u);
        for (const UvTriangle& triangle : triangles)
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_EQ(triangle.uvs[i],
                          scene.faces[triangle.face].lightmap_uvs[triangle.corners[i]]);
    }
}

TEST(AuthoredCharts, FlipVTurnsTheImageUpsideDown) {
    const auto upright =
        laid_out(square(in_part({0, 0}, {1, 0.5})), {.padding = 0, .atlas_size = 16});
    const auto flipped = laid_out(square(in_part({0, 0}, {1, 0.5})),
                                  {.padding = 0, .atlas_size = 16, .flip_v = true});

    EXPECT_GT(lit_by_x(upright).coverage[0], 0.0f);
    EXPECT_EQ(lit_by_x(flipped).coverage[0], 0.0f);
    EXPECT_GT(lit_by_x(flipped).coverage[255], 0.0f);
}

TEST(AuthoredCharts, FacesWithoutUvsGetGeneratedChartsInAnAtlasOfTheirOwn) {
    Scene scene = square(kWhole);
    add_square(scene, 5, {}, 1);

    const auto [mesh, layout] = laid_out(scene, {.texel_size = 0.25, .atlas_size = 16});

    ASSERT_EQ(layout.atlases.size(), 2u);
    ASSERT_EQ(layout.charts.size(), 1u);
    EXPECT_EQ(layout.charts[0].atlas, 1u);
    const auto triangles = lightmap_uvs(scene, mesh, layout);
    EXPECT_EQ(triangles[0].atlas, 0u);
    EXPECT_EQ(triangles[3].atlas, 1u);
}

TEST(AuthoredCharts, GeneratedChartsTakeTheirPlaceOnRequest) {
    const auto [mesh, layout] =
        laid_out(square(kWhole), {.texel_size = 0.1, .source = ChartSource::generated});

    EXPECT_TRUE(layout.authored.empty());
    EXPECT_EQ(layout.charts.size(), 1u);
}

TEST(AuthoredCharts, AnObjectThatOverlapsItselfIsRefusedByName) {
    Scene scene = square(kWhole);
    add_square(scene, 5, in_part({0.25, 0.25}, {0.5, 0.5}));

    EXPECT_EQ(refusal(scene).substr(0, 61),
              "hand.obj: \"floor\": its triangles overlap in TEXCOORD_1, as at");
}

// As Smart UV Project of Blender lays out its own monkey.
TEST(AuthoredCharts, AnObjectThatHardlyOverlapsItselfIsUsedWithAWarning) {
    Scene scene = square(kWhole);
    add_square(scene, 5, in_part({0.25, 0.5}, {0.3125, 0.5625}));

    const Laid laid = laid_out(scene);

    EXPECT_EQ(laid.layout.atlases.size(), 1u);
    ASSERT_EQ(laid.layout.warnings.size(), 1u);
    EXPECT_EQ(laid.layout.warnings[0],
              "hand.obj: \"floor\": 0.39 % of its triangles' area overlaps in TEXCOORD_1, as at "
              "(0.2812, 0.5312): a texel there shows one place of two");
    EXPECT_EQ(lit_by_x(laid).coverage[8 * 16 + 4], 1.0f);
}

TEST(AuthoredCharts, AnObjectThatOverlapsAnotherGoesToTheNextAtlasWithAWarning) {
    Scene scene = square(kWhole);
    add_square(scene, 5, kWhole, 1);

    const auto [mesh, layout] = laid_out(scene);

    EXPECT_EQ(layout.atlases.size(), 2u);
    EXPECT_EQ(layout.authored[0].atlas, 0u);
    EXPECT_EQ(layout.authored[3].atlas, 1u);
    ASSERT_EQ(layout.moved.size(), 1u);
    EXPECT_EQ(
        layout.moved[0],
        "hand.obj: \"other\": its TEXCOORD_1 claim texels of \"floor\": it goes to lightmap 1");
}

TEST(AuthoredCharts, ObjectsBesideEachOtherShareAnAtlasAndItsTexelsAtTheBorder) {
    Scene scene = square(in_part({0, 0}, {0.47, 1}));
    add_square(scene, 5, in_part({0.47, 0}, {1, 1}), 1);

    EXPECT_EQ(laid_out(scene).layout.atlases.size(), 1u);
    EXPECT_TRUE(laid_out(scene).layout.warnings.empty());
}

TEST(AuthoredCharts, UvsOutsideOfTheLightmapAreRefusedByName) {
    const std::string said = refusal(square(in_part({0, 0}, {1.5, 1})));

    EXPECT_EQ(said.substr(0, 59), "hand.obj: \"floor\": TEXCOORD_1 (1.5, 1) is outside of 0 to 1");
}

TEST(AuthoredCharts, MirroredAndFlatTrianglesAreToldByName) {
    Scene scene = square(kWhole);
    add_square(scene, 5, Uvs(4, {0.5, 0.5}));
    EXPECT_EQ(
        laid_out(scene).layout.warnings.back(),
        "hand.obj: \"floor\": 2 triangles are without area in TEXCOORD_1, no texel shows them");

    Uvs mirrored = kWhole;
    std::reverse(mirrored.begin(), mirrored.end());
    EXPECT_EQ(
        laid_out(square(mirrored)).layout.warnings.back(),
        "hand.obj: \"floor\": 2 triangles are mirrored in TEXCOORD_1, as all are: is V to run "
        "up (--flip-v)?");
}

TEST(AuthoredCharts, TrianglesWithoutAreaInTheLightmapDoNotAskForTexels) {
    Scene scene = square(kWhole);
    for (double x = 5; x < 500; x += 5) add_square(scene, x, Uvs(4, {0.5, 0.5}));

    const auto layout = laid_out(scene, {.texel_size = 0.25}).layout;

    ASSERT_EQ(layout.atlases.size(), 1u);
    EXPECT_EQ(layout.atlases[0].width, 4u);
}

// As exporters write them who have none.
TEST(AuthoredCharts, AnObjectWhoseUvsHaveNoAreaGetsGeneratedChartsWithAWarning) {
    Scene scene = square(kWhole);
    add_square(scene, 5, Uvs(4, {0, 0}), 1);

    const auto [mesh, layout] = laid_out(scene, {.texel_size = 0.25});

    EXPECT_EQ(layout.authored.size(), 2u);
    ASSERT_EQ(layout.charts.size(), 1u);
    EXPECT_EQ(layout.charts[0].atlas, 1u);
    EXPECT_EQ(lightmap_uvs(scene, mesh, layout).back().atlas, 1u);
    ASSERT_EQ(layout.warnings.size(), 1u);
    EXPECT_EQ(layout.warnings[0],
              "hand.obj: \"other\": TEXCOORD_1 are without area, charts are generated");
}

TEST(AuthoredCharts, ASceneWhoseUvsHaveNoAreaGetsNoAtlasOfThem) {
    const auto layout = laid_out(square(Uvs(4, {0, 0})), {.texel_size = 0.25}).layout;

    EXPECT_TRUE(layout.authored.empty());
    ASSERT_EQ(layout.atlases.size(), 1u);
    EXPECT_LT(layout.atlases[0].width, 64u);
}

Scene instances(std::uint32_t count, const Uvs& uvs) {
    Scene scene = empty_scene();
    scene.objects.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
        scene.objects.push_back(std::to_string(i));
        add_square(scene, 2 * i, uvs, i);
    }
    return scene;
}

TEST(AuthoredCharts, InstancesThatWouldFillMoreThanAThousandLightmapsAreRefused) {
    EXPECT_EQ(laid_out(instances(1024, kWhole), {.atlas_size = 1}).layout.atlases.size(), 1024u);
    EXPECT_EQ(refusal(instances(1025, kWhole), {.atlas_size = 1}),
              "hand.obj: \"1024\": its TEXCOORD_1 claim texels of objects in each of 1024 "
              "lightmaps of 1 x 1 texels, the most there may be; --charts generated ignores the "
              "scene's and lays out new ones");
}

// An eighth of a texel wide, as high as the atlas, one in each 256 columns.
TEST(AuthoredCharts, StripsTakeNoMoreMemoryThanWhatTheyCross) {
    Scene scene = empty_scene();
    for (std::uint32_t i = 0; i < 32; ++i)
        add_square(scene, 2 * i, in_part({i / 32.0, 0}, {i / 32.0 + 1 / 65536.0, 1}));

    const auto asked = test::peak_growth([&] { laid_out(scene, {.atlas_size = 8192}); });

    EXPECT_LT(asked, std::size_t{300} << 20);
}

TEST(AuthoredCharts, LightmapsOfMoreTexelsThanAreMadeAreRefusedBeforeMemoryIsAskedFor) {
    const Uvs uvs = in_part({0.5, 0.5}, {0.501, 0.501});
    const auto asked = test::peak_growth([&] {
        EXPECT_EQ(laid_out(instances(4, uvs), {.atlas_size = 8192}).layout.atlases.size(), 4u);
        EXPECT_EQ(refusal(instances(5, uvs), {.atlas_size = 8192}),
                  "hand.obj: \"4\": its TEXCOORD_1 claim texels of objects in each of 4 lightmaps "
                  "of 8192 x 8192 texels, the most there may be, a smaller --atlas-size aside; "
                  "--charts generated ignores the scene's and lays out new ones");
    });
    EXPECT_LT(asked, std::size_t{300} << 20);
}

}  // namespace
}  // namespace hemirad::authored_charts_test
