#include "lightmap/write_gltf.h"

#include <gmock/gmock.h>

#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "errors.h"
#include "lightmap/rasterize.h"
#include "lightmap/support.h"
#include "scene/bounds.h"
#include "scene/read_scene.h"

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>

namespace hemirad::write_gltf_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

/// A quad of 2 x 1 m in z = 0 and what it is lit by: 0 W/m^2 at its left end, 8 at its right.
struct Lit {
    Scene scene;
    Mesh mesh;
    ChartLayout layout;
    Lightmap lightmap;
    std::vector<Camera> cameras = {};
};

Scene quad(glm::dvec3 shift = {}) {
    Scene scene;
    scene.file = "quad.obj";
    scene.bands = {"R", "G", "B"};
    scene.positions = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    scene.faces = {{{0, 1, 2, 3}, 0, 0}};
    scene.materials = {{"paint", {0.1, 0.2, 0.3}, {0, 1, 4}, false}};
    scene.objects = {"sheet"};
    for (glm::dvec3& p : scene.positions) p += shift;
    return scene;
}

Lit lit(Scene scene) {
    Lit lit{std::move(scene), {}, {}, {}};
    lit.mesh = build_mesh(lit.scene, {.patch_size = 1, .backfaces = Backfaces::cull});
    lit.layout = lay_out_charts(lit.mesh, {.texel_size = 0.25});
    Solution solution;
    solution.bands = lit.scene.bands;
    solution.irradiance.assign(3, std::vector<double>(lit.mesh.patches.size()));
    for (std::size_t i = 0; i < lit.mesh.patches.size(); ++i)
        solution.irradiance[0][i] = lit.mesh.centroid(lit.mesh.patches[i]).x < 1 ? 0 : 8;
    lit.lightmap = rasterize(lit.mesh, solution, lit.layout, Quantity::irradiance);
    return lit;
}

class WriteGltf : public InFolder {
  protected:
    Scene round_trip(const Lit& lit, const std::string& name = "a.glb") const {
        write_gltf(file(name), lit.scene, lit.mesh, lit.cameras,
                   lightmap_uvs(lit.scene, lit.mesh, lit.layout), {lightmap_image(lit.lightmap)},
                   "a.exr");
        return read_scene(file(name));
    }
    nlohmann::json json() const { return nlohmann::json::parse(bytes_of(file("a.gltf"))); }
};

/// Where the lightmap shows what lies at a corner, in texels.
glm::dvec2 texel_of(const Lit& lit, const Scene& read, const glm::dvec3& corner) {
    for (const Face& face : read.faces)
        for (std::size_t i = 0; i < 3; ++i)
            if (glm::distance(read.positions[face.vertices[i]], corner) < 1e-6)
                return face.lightmap_uvs[i] * glm::dvec2(lit.lightmap.width, lit.lightmap.height);
    ADD_FAILURE() << "no such corner";
    return {};
}

TEST_F(WriteGltf, AQuadComesBackAsTwoTrianglesOfItsObjectAndMaterial) {
    const Scene read = round_trip(lit(quad()));

    ASSERT_EQ(read.faces.size(), 2u);
    EXPECT_EQ(read.positions.size(), 4u);
    EXPECT_THAT(read.objects, ElementsAre("sheet"));
    EXPECT_EQ(read.materials[0].name, "paint");
    EXPECT_THAT(read.materials[0].reflectance, ElementsAre(0.1, 0.2, 0.3));
    EXPECT_THAT(read.materials[0].emission, ElementsAre(0, 1, 4));
}

TEST_F(WriteGltf, CornersLeadToTheChartsOwnCorners) {
    const Lit a = lit(quad());
    const Scene read = round_trip(a);
    const Chart& chart = a.layout.charts[0];

    for (const glm::dvec3& corner : a.scene.positions) {
        const glm::dvec2 expected = atlas_from_world(chart, a.mesh.surfaces[0], corner);
        EXPECT_LT(glm::distance(texel_of(a, read, corner), expected), 1e-5);
    }
}

/// The picture in a .glb, by its signature.
std::vector<unsigned char> pixels_in(const std::string& glb, int& width, int& height) {
    const std::string bytes = glb.substr(glb.find("\x89PNG"));
    int channel_count = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
        stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                              static_cast<int>(bytes.size()), &width, &height, &channel_count, 3),
        stbi_image_free);
    return pixels ? std::vector(pixels.get(), pixels.get() + width * height * 3)
                  : std::vector<unsigned char>{};
}

TEST_F(WriteGltf, PngTimesIntensityIsIrradiance) {
    const Lit a = lit(quad());
    round_trip(a, "a.gltf");
    round_trip(a, "a.glb");

    const auto lightmap = json()["materials"][0]["extensions"]["MOZ_lightmap"];
    const double intensity = lightmap["intensity"];
    int width = 0, height = 0;
    const auto pixels = pixels_in(bytes_of(file("a.glb")), width, height);
    EXPECT_EQ(lightmap["texCoord"], 1);
    EXPECT_EQ(intensity, 8.0);
    ASSERT_EQ(pixels.size(), 3 * a.lightmap.texel_count());
    for (std::size_t i = 0; i < a.lightmap.texel_count(); ++i)
        EXPECT_NEAR(pixels[3 * i] / 255.0 * intensity, a.lightmap.values[0][i], intensity / 510);
}

TEST_F(WriteGltf, BothSidesOfADoubleSidedSheetAreThere) {
    Scene scene = quad();
    scene.materials[0].double_sided = true;

    const Scene read = round_trip(lit(scene));

    ASSERT_EQ(read.faces.size(), 4u);
    int fronts = 0;
    for (const Face& face : read.faces) {
        const auto at = [&](std::size_t i) { return read.positions[face.vertices[i]]; };
        fronts += glm::cross(at(1) - at(0), at(2) - at(0)).z > 0;
    }
    EXPECT_EQ(fronts, 2);
    EXPECT_FALSE(read.materials[0].double_sided);
}

TEST_F(WriteGltf, FarFromTheOriginNothingIsRounded) {
    const glm::dvec3 shift(4e6, -5e5, 1e7);  // a float there is a metre
    Scene scene = quad(shift);
    scene.quantum = 1e-6;

    const Scene read = round_trip(lit(scene));

    double largest = 0;
    for (const glm::dvec3& p : read.positions) largest = std::max(largest, p.x - shift.x);
    EXPECT_NEAR(largest, 2, 1e-6);
}

TEST_F(WriteGltf, CamerasComeBackAsTheyWere) {
    Lit a = lit(quad());
    a.cameras = {{"door", {1, 2, 3}, {0, 0.6, -0.8}, {0, 0.8, 0.6}, 0.5, 1.5}};

    round_trip(a);

    const auto read = read_cameras(file("a.glb"));
    ASSERT_EQ(read.size(), 1u);
    const Camera& camera = read[0];
    EXPECT_EQ(camera.name, "door");
    EXPECT_EQ(camera.yfov, 0.5);
    EXPECT_EQ(camera.aspect, 1.5);
    EXPECT_LT(glm::distance(camera.eye, {1, 2, 3}), 1e-12);
    EXPECT_LT(glm::distance(camera.forward, {0, 0.6, -0.8}), 1e-12);
    EXPECT_LT(glm::distance(camera.up, {0, 0.8, 0.6}), 1e-12);
}

TEST_F(WriteGltf, VerticesThatNoFaceUsesRoundNothing) {
    const glm::dvec3 shift(4e6 + 0.123, -5e5 - 0.123, 1e7 + 0.123);
    Scene scene = quad(shift);
    scene.quantum = 1e-6;
    scene.positions.emplace_back(0);

    const Scene read = round_trip(lit(scene));

    const Bounds bounds = bounds_of(read.positions);
    EXPECT_LT(glm::distance(bounds.least, shift), 1e-6);
    EXPECT_LT(glm::distance(bounds.most, shift + glm::dvec3(2, 1, 0)), 1e-6);
}

TEST_F(WriteGltf, RefusesWhatFloatsCannotHold) {
    Scene scene = quad();
    for (glm::dvec3& p : scene.positions) p *= 1e40;
    Lit a = lit(quad());
    a.scene = scene;

    try {
        round_trip(a);
        FAIL() << "written";
    } catch (const OutputError& error) {
        EXPECT_EQ(error.what(),
                  file("a.glb").string() + ": a coordinate of 2e+40 m is beyond glTF's floats");
    }
    EXPECT_FALSE(std::filesystem::exists(file("a.glb")));
}

TEST_F(WriteGltf, BandsOfItsOwnComeBack) {
    Scene scene = quad();
    scene.bands = {"450nm", "nir"};
    scene.materials[0] = {"paint", {0.2, 0.7}, {0, 3}, false};
    Lit a{scene, build_mesh(scene, {.patch_size = 1}), {}, {}};
    a.layout = lay_out_charts(a.mesh);
    const Atlas& atlas = a.layout.atlases[0];
    a.lightmap = {atlas.width, atlas.height, scene.bands, {}, {}};
    a.lightmap.values.assign(2, std::vector<float>(a.lightmap.texel_count(), 1.0f));

    const Scene read = round_trip(a);

    EXPECT_EQ(read.bands, scene.bands);
    EXPECT_THAT(read.materials[0].reflectance, ElementsAre(0.2, 0.7));
    EXPECT_THAT(read.materials[0].emission, ElementsAre(0, 3));
}

TEST_F(WriteGltf, TheExactLightmapIsNamed) {
    round_trip(lit(quad()), "a.gltf");

    EXPECT_EQ(json()["asset"]["extras"]["hemirad"]["exr"], "a.exr");
}

}  // namespace
}  // namespace hemirad::write_gltf_test
