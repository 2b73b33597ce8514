#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/read_scene.h"
#include "scene/scene_folder.h"
#include "support/seconds_since.h"

namespace hemirad::test::read_gltf_test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One black pixel beside a white one, by stb_image_write.
const std::string kBlackAndWhitePng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAADklEQVR4XmMAgv///"
    "wMABgEC/i9ySPYAAAAASUVORK5CYII=";
// 8 x 8 pixels of sRGB (200, 100, 50), by stb_image_write at quality 90.
const std::string kBrownJpeg =
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wCEAAMCAgMCAgMDAwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEB"
    "YQERMUFRUVDA8XGBYUGBIUFRQBAwQEBQQFCQUFCRQNCw0UFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQU"
    "FBQUFBQUFBQUFBQUFP/AABEIAAgACAMBIgACEQEDEQH/xAGiAAABBQEBAQEBAQAAAAAAAAAAAQIDBAUGBwgJCgsQAAIBAw"
    "MCBAMFBQQEAAABfQECAwAEEQUSITFBBhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJChYXGBkaJSYnKCkqNDU2Nzg5OkNE"
    "RUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqSk5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxs"
    "fIycrS09TV1tfY2drh4uPk5ebn6Onq8fLz9PX29/j5+gEAAwEBAQEBAQEBAQAAAAAAAAECAwQFBgcICQoLEQACAQIEBAME"
    "BwUEBAABAncAAQIDEQQFITEGEkFRB2FxEyIygQgUQpGhscEJIzNS8BVictEKFiQ04SXxFxgZGiYnKCkqNTY3ODk6Q0RFRk"
    "dISUpTVFVWV1hZWmNkZWZnaGlqc3R1dnd4eXqCg4SFhoeIiYqSk5SVlpeYmZqio6Slpqeoqaqys7S1tre4ubrCw8TFxsfI"
    "ycrS09TV1tfY2dri4+Tl5ufo6ery8/T19vf4+fr/2gAMAwEAAhEDEQA/AKtFFFfh5/SB/9k=";

class ReadGltf : public ::testing::Test {
  protected:
    SceneFolder folder;
};

glm::dvec3 normal(const Scene& scene, const Face& face) {
    const auto corner = [&](std::size_t i) { return scene.positions[face.vertices[i]]; };
    return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

std::vector<glm::dvec3> corners(const Scene& scene, const Face& face) {
    std::vector<glm::dvec3> result;
    for (const auto vertex : face.vertices) result.push_back(scene.positions[vertex]);
    return result;
}

TEST_F(ReadGltf, ReadsATriangleWithoutMaterialAsWhite) {
    const Scene scene = folder.read(triangle_gltf());

    ASSERT_EQ(scene.faces.size(), 1u);
    EXPECT_THAT(corners(scene, scene.faces[0]),
                ElementsAre(glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)));
    EXPECT_EQ(scene.materials.at(0).name, "default");
    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(1, 1, 1));
    EXPECT_THAT(scene.materials.at(0).emission, ElementsAre(0, 0, 0));
    EXPECT_FALSE(scene.materials.at(0).double_sided);
    EXPECT_THAT(scene.bands, ElementsAre("R", "G", "B"));
    EXPECT_EQ(scene.file, "room.gltf");
    EXPECT_THAT(scene.warnings, IsEmpty());
}

std::string big_endian(std::size_t value) {
    std::string bytes = little_endian(value);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// A PNG of red, green and blue; nobody looks at its checksums.
std::string png(std::size_t width, std::size_t height, char bits, const std::string& deflated) {
    const std::string header = "IHDR" + big_endian(width) + big_endian(height) + bits + "\x02" +
                               std::string(3 + 4, '\0');  // methods and a checksum
    return "\x89PNG\r\n\x1a\n" + big_endian(13) + header + big_endian(deflated.size()) + "IDAT" +
           deflated + std::string(4, '\0') + big_endian(0) + "IEND" + std::string(4, '\0');
}

/// As far as its size.
std::string png_of(std::size_t width, std::size_t height, char bits = 8) {
    return "data:image/png;base64," + base64(png(width, height, bits, ""));
}

/// Stored, not compressed: a block a row (RFC 1951, sec. 3.2.4).
std::string white_png(std::size_t side) {
    const std::size_t length = 1 + 3 * side;
    std::string rows("\x78\x01", 2);
    for (std::size_t row = 0; row < side; ++row) {
        rows += char(row + 1 == side);
        rows += little_endian(length).substr(0, 2) + little_endian(~length).substr(0, 2);
        rows += '\0' + std::string(length - 1, '\xff');
    }
    return png(side, side, 8, rows + std::string(4, '\0'));
}

TEST_F(ReadGltf, RefusesAFileThatItWouldHoldAgainAndAgain) {
    folder.write("a.bin", std::string(1 << 20, '\0'));
    Json gltf = triangle_gltf();
    const Json buffer = {{"byteLength", 1 << 20}, {"uri", "a.bin"}};
    for (int i = 0; i <= 256; ++i) gltf["buffers"].push_back(buffer);
    EXPECT_EQ(folder.error_of(gltf), "");

    gltf["buffers"].push_back(buffer);

    EXPECT_EQ(folder.error_of(gltf), "room.gltf: glTF: File read error : " +
                                         (folder.path() / "a.bin").string() + " : cannot be read");
}

TEST_F(ReadGltf, ReadsTheSameFromABinaryFile) {
    const Scene scene = folder.read("room.GLB", glb(triangle_gltf()));

    ASSERT_EQ(scene.faces.size(), 1u);
    EXPECT_EQ(scene.positions.at(2), glm::dvec3(0, 1, 0));
}

TEST_F(ReadGltf, ReadsAnExternalBufferBesideTheFile) {
    Json gltf = triangle_gltf();
    gltf["buffers"][0]["uri"] = "my%20data/room.bin";
    folder.write("my data/room.bin", bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 5, 0}));

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions.at(2), glm::dvec3(0, 5, 0));
}

/// As many as a file may hold that has little else.
TEST_F(ReadGltf, TakesManySmallNodes) {
    Json gltf = triangle_gltf();
    gltf["nodes"] = Json(30000, {{"mesh", 0}});

    EXPECT_EQ(folder.read(gltf).faces.size(), 30000u);
}

// --- Nodes ---------------------------------------------------------------------------------------

TEST_F(ReadGltf, NamesObjectsAfterNodeThenMeshThenNumber) {
    Json gltf = triangle_gltf();
    gltf["meshes"].push_back(gltf["meshes"][0]);
    gltf["meshes"][1].erase("name");
    gltf["nodes"] = {{{"name", "sheet"}, {"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 1}}};

    const Scene scene = folder.read(gltf);

    EXPECT_THAT(scene.objects, ElementsAre("sheet", "triangle", "node2"));
    EXPECT_EQ(scene.faces.at(2).object, 2u);
}

TEST_F(ReadGltf, PlacesAMeshByEveryNodeThatUsesIt) {
    Json gltf = triangle_gltf();
    gltf["nodes"].push_back({{"name", "copy"}, {"mesh", 0}, {"translation", {0, 0, 5}}});

    const Scene scene = folder.read(gltf);

    ASSERT_EQ(scene.faces.size(), 2u);
    EXPECT_EQ(corners(scene, scene.faces[0])[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(corners(scene, scene.faces[1])[1], glm::dvec3(1, 0, 5));
}

TEST_F(ReadGltf, ScalesThenTurnsThenMoves) {
    Json gltf = triangle_gltf();
    const double half = std::sqrt(0.5);  // a quarter turn about z
    gltf["nodes"][0]["scale"] = {2, 3, 1};
    gltf["nodes"][0]["rotation"] = {0, 0, half, half};
    gltf["nodes"][0]["translation"] = {10, 20, 30};

    const Scene scene = folder.read(gltf);

    EXPECT_NEAR(glm::distance(scene.positions[1], glm::dvec3(10, 22, 30)), 0, 1e-14);
    EXPECT_NEAR(glm::distance(scene.positions[2], glm::dvec3(7, 20, 30)), 0, 1e-14);
}

TEST_F(ReadGltf, ReadsMatricesByColumns) {
    Json gltf = triangle_gltf();
    gltf["nodes"][0]["matrix"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1};

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions[1], glm::dvec3(7, 9, 9));
    EXPECT_EQ(scene.positions[2], glm::dvec3(6, 8, 9));
}

TEST_F(ReadGltf, AppliesParentsAfterChildren) {
    Json gltf = triangle_gltf();
    gltf["nodes"] = {{{"scale", {2, 2, 2}}, {"children", {1}}},
                     {{"translation", {1, 0, 0}}, {"mesh", 0}}};

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions[1], glm::dvec3(4, 0, 0));
}

TEST_F(ReadGltf, KeepsTheFrontOfMirroredNodes) {
    Json gltf = triangle_gltf();
    gltf["nodes"][0]["scale"] = {-1, 1, 1};

    const Scene scene = folder.read(gltf);

    // Mirrored in x, a triangle that looks to +z still looks to +z.
    EXPECT_EQ(normal(scene, scene.faces[0]), glm::dvec3(0, 0, 1));
}

TEST_F(ReadGltf, ReadsOnlyTheDefaultScene) {
    Json gltf = triangle_gltf();
    gltf["nodes"].push_back({{"name", "other"}, {"mesh", 0}});
    gltf["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
    gltf["scene"] = 1;

    EXPECT_THAT(folder.read(gltf).objects, ElementsAre("other"));
}

TEST_F(ReadGltf, ReadsATreeOfAHundredThousandLevels) {
    Json gltf = triangle_gltf();
    constexpr int kLevels = 100000;
    gltf["nodes"] = Json::array();
    for (int i = 1; i < kLevels; ++i) {
        gltf["nodes"].push_back({{"translation", {1, 0, 0}}, {"children", {i}}});
    }
    gltf["nodes"].push_back({{"mesh", 0}});

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions[0], glm::dvec3(kLevels - 1, 0, 0));
}

// --- Primitives ----------------------------------------------------------------------------------

/// A square of four positions, as a primitive of the given mode.
Json square_gltf(int mode) {
    Json gltf = triangle_gltf();
    const std::size_t square = add_positions(gltf, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    gltf["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", square}}}, {"mode", mode}};
    return gltf;
}

TEST_F(ReadGltf, ReadsStripsWithOneFront) {
    const Scene scene = folder.read(square_gltf(5));

    ASSERT_EQ(scene.faces.size(), 2u);
    EXPECT_EQ(normal(scene, scene.faces[0]), glm::dvec3(0, 0, 1));
    EXPECT_EQ(normal(scene, scene.faces[1]), glm::dvec3(0, 0, 1));
    EXPECT_EQ(corners(scene, scene.faces[1])[1], glm::dvec3(1, 1, 0));
}

TEST_F(ReadGltf, ReadsFans) {
    Json gltf = square_gltf(6);
    gltf["meshes"][0]["primitives"][0]["indices"] =
        add_accessor(gltf, std::vector<std::uint8_t>{0, 1, 3, 2}, "SCALAR", 5121, 4);

    const Scene scene = folder.read(gltf);

    ASSERT_EQ(scene.faces.size(), 2u);
    EXPECT_EQ(normal(scene, scene.faces[0]), glm::dvec3(0, 0, 1));
    EXPECT_EQ(normal(scene, scene.faces[1]), glm::dvec3(0, 0, 1));
}

template <class Index>
void expect_indices_read(const SceneFolder& folder, int component_type) {
    Json gltf = square_gltf(4);
    gltf["meshes"][0]["primitives"][0]["indices"] =
        add_accessor(gltf, std::vector<Index>{0, 1, 3, 0, 3, 2}, "SCALAR", component_type, 6);

    const Scene scene = folder.read(gltf);

    ASSERT_EQ(scene.faces.size(), 2u);
    EXPECT_THAT(scene.faces[1].vertices, ElementsAre(0, 3, 2));
}

TEST_F(ReadGltf, ReadsIndicesOfEverySize) {
    expect_indices_read<std::uint8_t>(folder, 5121);
    expect_indices_read<std::uint16_t>(folder, 5123);
    expect_indices_read<std::uint32_t>(folder, 5125);
}

TEST_F(ReadGltf, ReadsSeveralMaterialsOfAMeshAsOneObject) {
    Json gltf = triangle_gltf(Json{{"name", "a"}});
    gltf["materials"].push_back({{"name", "b"}});
    gltf["meshes"][0]["primitives"].push_back(gltf["meshes"][0]["primitives"][0]);
    gltf["meshes"][0]["primitives"][1]["material"] = 1;

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions.size(), 3u) << "shared positions are read once";
    EXPECT_EQ(scene.faces[0].object, scene.faces[1].object);
    EXPECT_EQ(scene.faces[1].material, 1u);
}

TEST_F(ReadGltf, ReadsInterleavedPositions) {
    Json gltf = triangle_gltf();
    const std::size_t accessor = add_positions(gltf, {9, 0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0, 9});
    gltf["bufferViews"][1]["byteStride"] = 20;
    gltf["accessors"][accessor]["byteOffset"] = 4;
    gltf["accessors"][accessor]["count"] = 3;
    gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(scene.positions[2], glm::dvec3(0, 1, 0));
}

TEST_F(ReadGltf, ReadsNormalisedIntegers) {
    Json gltf = triangle_gltf();
    const std::size_t accessor = add_accessor(
        gltf, std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, -32768, 0}, "VEC3", 5122, 3);
    gltf["accessors"][accessor]["normalized"] = true;
    gltf["extensionsRequired"] = {"KHR_mesh_quantization"};
    gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(scene.positions[2], glm::dvec3(0, -1, 0));
}

/// Replaces vertex 1 of the triangle by (7, 0, 0).
Json sparse_gltf(std::uint16_t index) {
    Json gltf = triangle_gltf();
    add_accessor(gltf, std::vector<std::uint16_t>{index}, "SCALAR", 5123, 1);
    add_positions(gltf, {7, 0, 0});
    gltf["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 2}}}};
    return gltf;
}

TEST_F(ReadGltf, ReadsSparsePositions) {
    const Scene scene = folder.read(sparse_gltf(1));

    EXPECT_EQ(scene.positions[1], glm::dvec3(7, 0, 0));
    EXPECT_EQ(scene.positions[2], glm::dvec3(0, 1, 0));
}

TEST_F(ReadGltf, SkipsPointsAndLinesWithAWarning) {
    Json gltf = triangle_gltf();
    auto& primitives = gltf["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[0]["mode"] = 1;

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.faces.size(), 1u);
    EXPECT_THAT(scene.warnings, ElementsAre("room.gltf: meshes/0/primitives/0: points and lines "
                                            "have no area, skipped"));
}

// --- Materials -----------------------------------------------------------------------------------

TEST_F(ReadGltf, TakesBaseColourAsReflectanceAndEmissionTimesStrengthAsRadiance) {
    const Scene scene = folder.read(triangle_gltf(
        {{"name", "lamp"},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}}},
         {"emissiveFactor", {1, 0.5, 0.25}},
         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 20}}}}},
         {"doubleSided", true}}));

    EXPECT_EQ(scene.materials[0].name, "lamp");
    EXPECT_THAT(scene.materials[0].reflectance, ElementsAre(0.1, 0.2, 0.3));
    EXPECT_THAT(scene.materials[0].emission, ElementsAre(20, 10, 5));
    EXPECT_TRUE(scene.materials[0].double_sided);
}

Json textured_gltf(const Json& material, const Json& image) {
    Json gltf = triangle_gltf(material);
    gltf["textures"] = Json::array({{{"source", 0}}});
    gltf["images"] = Json::array({image});
    return gltf;
}

TEST_F(ReadGltf, AveragesTexturesInLinearLight) {
    const Json material = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"baseColorTexture", {{"index", 0}}}}},
        {"emissiveFactor", {1, 1, 1}},
        {"emissiveTexture", {{"index", 0}}}};

    const Scene scene = folder.read(textured_gltf(material, {{"uri", kBlackAndWhitePng}}));

    // Half black, half white: 0.5 of the light, where the mean sRGB value would say 0.21.
    EXPECT_THAT(scene.materials[0].reflectance, ElementsAre(0.5, 0.25, 0.125));
    EXPECT_THAT(scene.materials[0].emission, ElementsAre(0.5, 0.5, 0.5));
}

TEST_F(ReadGltf, ReadsAJpegFromABufferView) {
    const Json material = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
    Json gltf = textured_gltf(material, {{"bufferView", 1}, {"mimeType", "image/jpeg"}});
    gltf["buffers"].push_back(
        {{"byteLength", 617}, {"uri", "data:application/octet-stream;base64," + kBrownJpeg}});
    gltf["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 617}});

    const Scene scene = folder.read(gltf);

    // sRGB 200, 100, 50 decoded by hand; JPEG keeps them to about two steps.
    EXPECT_THAT(
        scene.materials[0].reflectance,
        ElementsAre(DoubleNear(0.578, 0.015), DoubleNear(0.127, 0.01), DoubleNear(0.032, 0.005)));
}

TEST_F(ReadGltf, DoesNotMindAnImageThatNoMaterialShows) {
    Json gltf = textured_gltf({{"normalTexture", {{"index", 0}}}}, {{"uri", "missing.png"}});

    EXPECT_EQ(folder.error_of(gltf), "");
}

TEST_F(ReadGltf, SaysOfABufferWhoseNameNoFileCanHaveThatItCannotBeRead) {
    Json gltf = triangle_gltf();
    gltf["buffers"][0]["uri"] = std::string(256, 'a');

    EXPECT_THAT(folder.error_of(gltf), Not(AnyOf(IsEmpty(), HasSubstr("filesystem error"))));
}

TEST_F(ReadGltf, TakesBandsFromExtrasInOrderOfAppearance) {
    Json gltf = triangle_gltf(
        {{"name", "leaf"},
         {"extras", {{"reflectance", {{"red", 0.1}, {"450nm", 0.2}, {"nir", 0.5}}}}}});
    gltf["materials"].push_back(
        {{"name", "lamp"},
         {"extras",
          {{"emission", {{"uv", 3}, {"nir", 2.5}}},
           {"reflectance", {{"450nm", 0}, {"red", 0}, {"nir", 1}, {"uv", 0.25}}}}}});
    gltf["materials"][0]["extras"]["reflectance"]["uv"] = 0.125;

    const Scene scene = folder.read(gltf);

    EXPECT_THAT(scene.bands, ElementsAre("red", "450nm", "nir", "uv"));
    EXPECT_THAT(scene.materials[0].reflectance, ElementsAre(0.1, 0.2, 0.5, 0.125));
    EXPECT_THAT(scene.materials[0].emission, ElementsAre(0, 0, 0, 0));
    EXPECT_THAT(scene.materials[1].reflectance, ElementsAre(0, 0, 1, 0.25));
    EXPECT_THAT(scene.materials[1].emission, ElementsAre(0, 0, 2.5, 3));
}

TEST_F(ReadGltf, WarnsOfTransparency) {
    const Scene scene = folder.read(triangle_gltf({{"name", "glass"}, {"alphaMode", "BLEND"}}));

    EXPECT_THAT(scene.warnings, ElementsAre("room.gltf: material \"glass\": alphaMode is not read, "
                                            "the material is opaque"));
}

TEST_F(ReadGltf, WarnsOnceOfVertexColours) {
    Json gltf = triangle_gltf({{"name", "a"}});
    auto& primitives = gltf["meshes"][0]["primitives"];
    primitives[0]["attributes"]["COLOR_0"] = add_positions(gltf, {1, 0, 0, 1, 0, 0, 1, 0, 0});
    primitives.push_back(primitives[0]);

    EXPECT_THAT(folder.read(gltf).warnings,
                ElementsAre("room.gltf: COLOR_0: vertex colours are not read, faces have their "
                            "material's (meshes/0/primitives/0)"));
}

TEST_F(ReadGltf, DoesNotWarnOfVertexColoursThatNoNodeShows) {
    Json gltf = triangle_gltf({{"name", "a"}});
    gltf["meshes"].push_back(gltf["meshes"][0]);
    gltf["meshes"][1]["primitives"][0]["attributes"]["COLOR_0"] = 0;

    EXPECT_THAT(folder.read(gltf).warnings, IsEmpty());
}

TEST_F(ReadGltf, WarnsOnceOfInstances) {
    Json gltf = triangle_gltf({{"name", "a"}});
    gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = Json::object();
    gltf["nodes"].push_back(gltf["nodes"][0]);

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.faces.size(), 2u);
    EXPECT_THAT(scene.warnings, ElementsAre("room.gltf: EXT_mesh_gpu_instancing: instances are not "
                                            "read, a node shows its mesh once (nodes/0)"));
}

TEST_F(ReadGltf, WarnsOnceOfMaterialsOfSpecularGlossiness) {
    Json gltf = triangle_gltf(
        {{"name", "a"}, {"extensions", {{"KHR_materials_pbrSpecularGlossiness", Json::object()}}}});
    gltf["materials"].push_back(gltf["materials"][0]);

    EXPECT_THAT(folder.read(gltf).warnings,
                ElementsAre("room.gltf: KHR_materials_pbrSpecularGlossiness: is not read, "
                            "materials have the base colour beside it, or white "
                            "(material \"a\")"));
}

TEST_F(ReadGltf, EscapesControlCharactersInNames) {
    Json gltf = triangle_gltf(
        {{"name", "a\nb"}, {"pbrMetallicRoughness", {{"baseColorFactor", {2, 0, 0, 1}}}}});

    EXPECT_EQ(folder.error_of(gltf),
              "room.gltf: material \"a\\x0ab\": reflectance 2.00 is above 1");
}

// --- Bad input -----------------------------------------------------------------------------------

using Change = void (*)(Json&);

/// Of so many members, none of which is looked for among those before it.
Json object_of(int members) {
    Json::object_t object;
    for (int i = 0; i < members; ++i) object.emplace_back(std::to_string(i), 0);
    return object;
}

struct BadGltf {
    const char* name;
    Change change;
    std::string error;
};

class ReadBadGltf : public ::testing::TestWithParam<BadGltf> {};

TEST_P(ReadBadGltf, SaysWhatIsWrongInOneLine) {
    const SceneFolder folder;
    Json gltf = triangle_gltf({{"name", "whte"}});
    GetParam().change(gltf);

    EXPECT_EQ(folder.error_of(gltf), "room.gltf: " + GetParam().error);
}

void set_indices(Json& gltf, const std::vector<std::uint16_t>& indices) {
    gltf["meshes"][0]["primitives"][0]["indices"] =
        add_accessor(gltf, indices, "SCALAR", 5123, indices.size());
}

void set_coordinate(Json& gltf, float value) {
    gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        add_positions(gltf, {0, 0, 0, 1, value, 0, 0, 1, 0});
}

template <class... Values>
void set_base_colour(Json& gltf, Values... values) {
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {values...};
}

void add_texture(Json& gltf, const Json& image) {
    gltf["images"] = Json::array({image});
    gltf["textures"] = Json::array({{{"source", 0}}});
    gltf["materials"][0]["emissiveTexture"] = {{"index", 0}};
}

INSTANTIATE_TEST_SUITE_P(
    Geometry, ReadBadGltf,
    ::testing::Values(
        BadGltf{"NoNodes", [](Json& g) { g.erase("nodes"); }, "holds no faces"},
        BadGltf{"VertexOutOfRange",
                [](Json& g) {
                    set_indices(g, {0, 1, 3});
                },
                "meshes/0/primitives/0: vertex index 3 is out of range, it has 3 positions"},
        BadGltf{"PrimitiveRestart",
                [](Json& g) {
                    set_indices(g, {0, 1, 65535});
                },
                "meshes/0/primitives/0: vertex index 65535 is out of range, it has 3 positions"},
        BadGltf{"FourCorners",
                [](Json& g) {
                    set_indices(g, {0, 1, 2, 0});
                },
                "meshes/0/primitives/0: 4 corners make no triangles"},
        BadGltf{"FloatIndices",
                [](Json& g) {
                    g["meshes"][0]["primitives"][0]["indices"] =
                        add_accessor(g, std::vector<float>{0, 1, 2}, "SCALAR", 5126, 3);
                },
                "meshes/0/primitives/0: its indices are not unsigned integers"},
        BadGltf{"NanCoordinate",
                [](Json& g) { set_coordinate(g, std::numeric_limits<float>::quiet_NaN()); },
                "nodes/0: vertex 1 is not finite"},
        BadGltf{"InfiniteCoordinate",
                [](Json& g) { set_coordinate(g, std::numeric_limits<float>::infinity()); },
                "nodes/0: vertex 1 is not finite"},
        BadGltf{"OverflowingTransform",
                [](Json& g) {
                    set_coordinate(g, 3e38f);
                    g["nodes"][0]["scale"] = {1, 1e300, 1};
                },
                "nodes/0: vertex 1 is not finite"},
        BadGltf{"UnknownMode", [](Json& g) { g["meshes"][0]["primitives"][0]["mode"] = 7; },
                "meshes/0/primitives/0: mode 7"},
        BadGltf{"NoAttributes", [](Json& g) { g["meshes"][0]["primitives"][0] = Json::object(); },
                "meshes/0/primitives/0: holds no attributes"},
        BadGltf{"NoPrimitives", [](Json& g) { g["meshes"][0].erase("primitives"); },
                "meshes/0: holds no array of primitives"},
        BadGltf{"CycleOfOne", [](Json& g) { g["nodes"][0]["children"] = {0}; },
                "nodes/0: is its own ancestor"},
        BadGltf{"CycleOfTwo",
                [](Json& g) {
                    g["nodes"].push_back({{"children", {2}}});
                    g["nodes"].push_back({{"children", {1}}});
                },
                "nodes/1: is its own ancestor"},
        BadGltf{"TwoParents",
                [](Json& g) {
                    g["nodes"].push_back({{"children", {0}}});
                    g["nodes"].push_back({{"children", {0}}});
                },
                "nodes/0: is the child of two nodes"},
        BadGltf{"SceneNamesAChild",
                [](Json& g) {
                    g["nodes"].push_back({{"children", {0}}});
                    g["scenes"] = Json::array({{{"nodes", {0}}}});
                    g["scene"] = 0;
                },
                "nodes/0: is no root, but a scene's node"},
        BadGltf{"SceneNamesANodeTwice",
                [](Json& g) {
                    g["scenes"] = Json::array({{{"nodes", {0, 0}}}});
                    g["scene"] = 0;
                },
                "nodes/0: is twice in the scene"},
        BadGltf{"ZeroRotation",
                [](Json& g) {
                    g["nodes"][0]["rotation"] = {0, 0, 0, 0};
                },
                "nodes/0: its rotation is not a quaternion"},
        BadGltf{"ShortMatrix",
                [](Json& g) {
                    g["nodes"][0]["matrix"] = {1, 0, 0, 0};
                },
                "nodes/0/matrix: must be 16 numbers"},
        BadGltf{"TextInMatrix",
                [](Json& g) {
                    g["nodes"][0]["scale"] = {1, "x", 1};
                },
                "nodes/0/scale: must be 3 numbers"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    References, ReadBadGltf,
    ::testing::Values(
        BadGltf{"Scene", [](Json& g) { g["scene"] = 0; },
                "scene: 0 is out of range, the file holds 0 scenes"},
        BadGltf{"SceneNode",
                [](Json& g) {
                    g["scenes"] = Json::array({{{"nodes", {5}}}});
                },
                "scenes/0/nodes/0: 5 is out of range, the file holds 1 nodes"},
        BadGltf{"Child", [](Json& g) { g["nodes"][0]["children"] = {1}; },
                "nodes/0/children/0: 1 is out of range, the file holds 1 nodes"},
        BadGltf{"Mesh", [](Json& g) { g["nodes"][0]["mesh"] = 1; },
                "nodes/0/mesh: 1 is out of range, the file holds 1 meshes"},
        BadGltf{"NegativeMesh", [](Json& g) { g["nodes"][0]["mesh"] = -1; },
                "nodes/0/mesh: -1 is out of range"},
        BadGltf{"FractionalMesh", [](Json& g) { g["nodes"][0]["mesh"] = 0.5; },
                "nodes/0/mesh: is not an integer"},
        BadGltf{"Material", [](Json& g) { g["meshes"][0]["primitives"][0]["material"] = 1; },
                "meshes/0/primitives/0/material: 1 is out of range, the file holds 1 materials"},
        BadGltf{"Positions",
                [](Json& g) { g["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; },
                "meshes/0/primitives/0/attributes/POSITION: 9 is out of range, the file holds 1 "
                "accessors"},
        BadGltf{"Indices", [](Json& g) { g["meshes"][0]["primitives"][0]["indices"] = 9; },
                "meshes/0/primitives/0/indices: 9 is out of range, the file holds 1 accessors"},
        BadGltf{"BufferView", [](Json& g) { g["accessors"][0]["bufferView"] = 1; },
                "accessors/0/bufferView: 1 is out of range, the file holds 1 bufferViews"},
        BadGltf{"Buffer", [](Json& g) { g["bufferViews"][0]["buffer"] = 1; },
                "bufferViews/0/buffer: 1 is out of range, the file holds 1 buffers"},
        BadGltf{"Texture",
                [](Json& g) {
                    g["materials"][0]["emissiveTexture"] = {{"index", 0}};
                },
                "materials/0/emissiveTexture/index: 0 is out of range, the file holds 0 textures"},
        BadGltf{"Image",
                [](Json& g) {
                    add_texture(g, {{"uri", "a.png"}});
                    g["textures"][0]["source"] = 1;
                },
                "textures/0/source: 1 is out of range, the file holds 1 images"},
        BadGltf{"ImageView",
                [](Json& g) {
                    add_texture(g, {{"bufferView", 1}});
                },
                "images/0/bufferView: 1 is out of range, the file holds 1 bufferViews"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Buffers, ReadBadGltf,
    ::testing::Values(
        BadGltf{"ViewBeyondBuffer", [](Json& g) { g["bufferViews"][0]["byteLength"] = 37; },
                "bufferViews/0: ends at byte 37 of a buffer of 36"},
        BadGltf{"ViewOffsetBeyondBuffer", [](Json& g) { g["bufferViews"][0]["byteOffset"] = 4; },
                "bufferViews/0: ends at byte 40 of a buffer of 36"},
        BadGltf{"NegativeOffset", [](Json& g) { g["bufferViews"][0]["byteOffset"] = -4; },
                "bufferViews/0/byteOffset: -4 is out of range"},
        BadGltf{"ViewOfNothing", [](Json& g) { g["bufferViews"][0].erase("buffer"); },
                "bufferViews/0: needs a buffer and a byteLength"},
        BadGltf{"AccessorBeyondView", [](Json& g) { g["accessors"][0]["count"] = 4; },
                "accessors/0: ends at byte 48 of bufferView 0, which holds 36"},
        BadGltf{"HugeCount", [](Json& g) { g["accessors"][0]["count"] = 2147483647; },
                "accessors/0: ends at byte 25769803764 of bufferView 0, which holds 36"},
        BadGltf{"OverflowingCount",
                [](Json& g) { g["accessors"][0]["count"] = 18446744073709551615u; },
                "accessors/0/count: 18446744073709551615 is out of range"},
        BadGltf{"CountZero", [](Json& g) { g["accessors"][0]["count"] = 0; },
                "accessors/0/count: 0 is below 1"},
        BadGltf{"OverlappingElements", [](Json& g) { g["bufferViews"][0]["byteStride"] = 8; },
                "accessors/0: elements overlap: a byteStride of 8"},
        BadGltf{"NoView", [](Json& g) { g["accessors"][0].erase("bufferView"); },
                "accessors/0: has no bufferView"},
        BadGltf{"PlanePositions", [](Json& g) { g["accessors"][0]["type"] = "VEC2"; },
                "accessors/0: has 2 components instead of 3"},
        BadGltf{"DoublePositions", [](Json& g) { g["accessors"][0]["componentType"] = 5130; },
                "accessors/0: component type 5130"},
        BadGltf{"SparseIndex", [](Json& g) { g = sparse_gltf(3); },
                "accessors/0: sparse index 3.00 is out of range"},
        BadGltf{"SparseIndicesBeyondView",
                [](Json& g) {
                    g = sparse_gltf(1);
                    g["accessors"][0]["sparse"]["count"] = 2;
                },
                "accessors/0: ends at byte 4 of bufferView 1, which holds 2"},
        BadGltf{"SparseValuesAgainAndAgain",
                [](Json& g) {
                    g = sparse_gltf(1);
                    g["accessors"][0]["sparse"]["count"] = 4;
                },
                "accessors/0: has more sparse values than elements"},
        BadGltf{"ShortData", [](Json& g) { g["buffers"][0]["byteLength"] = 40; },
                "buffers/0: its data URI does not hold 40 bytes"}),
    [](const auto& test) { return test.param.name; });

/// Nodes that show one mesh, which shows all its corners again and again.
void multiply(Json& gltf, std::size_t corners, std::size_t primitives, std::size_t nodes) {
    set_indices(gltf, std::vector<std::uint16_t>(corners));
    auto& mesh = gltf["meshes"][0];
    mesh["primitives"] = Json(primitives, mesh["primitives"][0]);
    gltf["nodes"] = Json(nodes, gltf["nodes"][0]);
}

INSTANTIATE_TEST_SUITE_P(
    Amounts, ReadBadGltf,
    ::testing::Values(
        BadGltf{"ImageTooLarge",
                [](Json& g) {
                    add_texture(g, {{"uri", png_of(16384, 16384)}});
                },
                "images/0: is 16384 x 16384 pixels, more than the 134217728 that are read"},
        BadGltf{"ImageOf16BitsTooLarge",
                [](Json& g) {
                    add_texture(g, {{"uri", png_of(8192, 8193, 16)}});
                },
                "images/0: is 8192 x 8193 pixels, more than the 67108864 that are read"},
        BadGltf{"ImagesTogetherTooLarge",
                [](Json& g) {
                    g["images"] = Json(9, {{"uri", png_of(16384, 8192)}});
                    for (int i = 0; i < 9; ++i) {
                        g["textures"].push_back({{"source", i}});
                        g["materials"].push_back({{"emissiveTexture", {{"index", i}}}});
                    }
                },
                "images: are 1207959552 pixels in all, more than the 1073774656 that are read of "
                "513 bytes"},
        BadGltf{"ImageOfAnotherFormat",
                [](Json& g) {
                    add_texture(g, {{"uri", "data:image/png;base64," + base64("P6 1 1 255\nabc")}});
                },
                "images/0: is neither PNG nor JPEG, or is damaged"},
        BadGltf{"CornersMultiplied", [](Json& g) { multiply(g, 3000, 100, 100); },
                "nodes: show meshes of 30000300 vertices and corners, more than the 10006036 that "
                "are read of 6036 bytes"},
        BadGltf{"NameOfAMegabyte",
                [](Json& g) {
                    g["meshes"][0]["name"] = std::string(1 << 20, 'x'), g["nodes"][0].erase("name");
                },
                "object \"" + std::string(200, 'x') +
                    "...\": its name has 1048576 bytes, more than the 1000 that are read"},
        BadGltf{"MaterialsNameOfAMegabyte",
                [](Json& g) { g["materials"][0]["name"] = std::string(1 << 20, 'x'); },
                "material \"" + std::string(200, 'x') +
                    "...\": its name has 1048576 bytes, more than the 1000 that are read"},
        BadGltf{"BandsNameOfAMegabyte",
                [](Json& g) {
                    g["materials"][0]["extras"]["reflectance"][std::string(1 << 20, 'x')] = 0.5;
                },
                "band \"" + std::string(200, 'x') +
                    "...\": its name has 1048576 bytes, more than the 1000 that are read"},
        BadGltf{"AttributeOfAMegabyte",
                [](Json& g) {
                    g["meshes"][0]["primitives"][0]["attributes"][std::string(1 << 20, 'x')] = 7;
                },
                "meshes/0/primitives/0/attributes/" + std::string(100, 'x') +
                    ": 7 is out of range, the file holds 1 accessors"},
        BadGltf{"TooManyMembers", [](Json& g) { g["extras"] = object_of(10001); },
                "JSON: an object holds more than 10000 members"},
        BadGltf{"TooManyMembersTogether",
                [](Json& g) {
                    g["extras"] = object_of(8000);
                    g["asset"]["extras"] = object_of(8000);
                },
                "JSON: its objects hold too many members: squared and added up 127968066, more "
                "than the 102844580 that are read of 142229 bytes"},
        BadGltf{"TooManyObjects", [](Json& g) { g["extras"] = Json(20000, Json::object()); },
                "JSON: holds 20010 objects, more than the 15036 that are read of 60438 bytes"},
        BadGltf{"TooManyMaterials",
                [](Json& g) {
                    g["materials"] = Json(15000, {{"name", "a"}});
                },
                "materials: are 15000, more than the 13053 that are read of 195411 bytes"},
        BadGltf{"TooManyBands",
                [](Json& g) {
                    for (int i = 0; i <= 1000; ++i)
                        g["materials"][0]["extras"]["reflectance"][std::to_string(i)] = 0.5;
                },
                "materials: name more than 1000 bands"},
        BadGltf{"ReferenceOfAMegabyte",
                [](Json& g) { g["buffers"][0]["uri"] = "../" + std::string(1 << 20, 'x'); },
                "buffers/0/uri: \"../" + std::string(197, 'x') +
                    "...\" must be a file in the scene's folder"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Files, ReadBadGltf,
    ::testing::Values(
        BadGltf{"BufferOutside", [](Json& g) { g["buffers"][0]["uri"] = "../a.bin"; },
                "buffers/0/uri: \"../a.bin\" must be a file in the scene's folder"},
        BadGltf{"BufferFarOutside", [](Json& g) { g["buffers"][0]["uri"] = "b/../../a.bin"; },
                "buffers/0/uri: \"b/../../a.bin\" must be a file in the scene's folder"},
        BadGltf{"BufferAbsolute", [](Json& g) { g["buffers"][0]["uri"] = "/etc/passwd"; },
                "buffers/0/uri: \"/etc/passwd\" must be a file in the scene's folder"},
        BadGltf{"BufferOnTheNet", [](Json& g) { g["buffers"][0]["uri"] = "http://a/b.bin"; },
                "buffers/0/uri: \"http://a/b.bin\" must be a file in the scene's folder"},
        BadGltf{"BufferOutsideInDisguise",
                [](Json& g) { g["buffers"][0]["uri"] = "%2e%2e/outside.bin"; },
                "glTF: File not found : ../outside.bin"},
        BadGltf{"BufferMissing", [](Json& g) { g["buffers"][0]["uri"] = "a.bin"; },
                "glTF: File not found : a.bin"},
        BadGltf{"ImageOutside",
                [](Json& g) {
                    add_texture(g, {{"uri", "../a.png"}});
                },
                "images/0/uri: \"../a.png\" must be a file in the scene's folder"},
        BadGltf{"ImageMissing",
                [](Json& g) {
                    add_texture(g, {{"uri", "a.png"}});
                },
                "images/0: cannot be read"},
        BadGltf{"ImageBroken",
                [](Json& g) {
                    add_texture(g, {{"uri", "data:image/png;base64,AAAA"}});
                },
                "images/0: is neither PNG nor JPEG, or is damaged"},
        BadGltf{"ImageBeyondBuffer",
                [](Json& g) {
                    g["bufferViews"].push_back(
                        {{"buffer", 0}, {"byteOffset", 1 << 30}, {"byteLength", 99}});
                    add_texture(g, {{"bufferView", 1}});
                },
                "bufferViews/1: ends at byte 1073741923 of a buffer of 36"},
        BadGltf{"TextureWithoutImage",
                [](Json& g) {
                    add_texture(g, {{"uri", "a.png"}});
                    g["textures"][0].erase("source");
                },
                "textures/0: has no image"},
        BadGltf{"RequiredExtension",
                [](Json& g) { g["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
                "extensionsRequired/0: the extension \"KHR_draco_mesh_compression\" is not "
                "supported"},
        BadGltf{"NoAsset", [](Json& g) { g.erase("asset"); },
                "asset: holds no version, this is not glTF 2.0"},
        BadGltf{"OldVersion", [](Json& g) { g["asset"]["version"] = "1.0"; },
                "asset: glTF version \"1.0\""},
        BadGltf{"NeedsALaterVersion", [](Json& g) { g["asset"]["minVersion"] = "2.1"; },
                "asset/minVersion: needs glTF version \"2.1\""},
        BadGltf{"MinVersionIsANumber", [](Json& g) { g["asset"]["minVersion"] = 2; },
                "asset/minVersion: is not a string"},
        BadGltf{"NodesAreNoArray", [](Json& g) { g["nodes"] = 3; }, "nodes: is not an array"},
        BadGltf{"NodeIsNoObject", [](Json& g) { g["nodes"][0] = 3; }, "nodes/0: is not an object"},
        BadGltf{"DeepExtras",
                [](Json& g) {
                    for (int i = 0; i < 300; ++i) g["extras"] = Json::array({g["extras"]});
                },
                "JSON: is nested too deeply"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Spectra, ReadBadGltf,
    ::testing::Values(
        BadGltf{"ReflectanceAboveOne", [](Json& g) { set_base_colour(g, 1.2, 0, 0, 1); },
                "material \"whte\": reflectance 1.20 is above 1"},
        BadGltf{"ReflectanceNegative", [](Json& g) { set_base_colour(g, 0, -0.1, 0, 1); },
                "material \"whte\": reflectance -0.10 is below 0"},
        BadGltf{"ThreeNumbers", [](Json& g) { set_base_colour(g, 0, 0, 0); },
                "materials/0/pbrMetallicRoughness/baseColorFactor: must be 4 numbers"},
        BadGltf{"NullReflectance", [](Json& g) { set_base_colour(g, nullptr, 0, 0, 1); },
                "materials/0/pbrMetallicRoughness/baseColorFactor: must be 4 numbers"},
        BadGltf{"EmissionNegative",
                [](Json& g) {
                    g["materials"][0]["emissiveFactor"] = {0, -1, 0};
                },
                "material \"whte\": emission -1.00 is below 0"},
        BadGltf{"EmissionInfinite",
                [](Json& g) {
                    g["materials"][0]["emissiveFactor"] = {1e300, 0, 0};
                    g["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
                        {"emissiveStrength", 1e300}};
                },
                "material \"whte\": emission is not finite"},
        BadGltf{"StrengthIsText",
                [](Json& g) {
                    g["materials"][0]["extensions"]["KHR_materials_emissive_strength"] = {
                        {"emissiveStrength", "much"}};
                },
                "material \"whte\": emissiveStrength is no number"},
        BadGltf{"MaterialWithoutBands",
                [](Json& g) {
                    g["materials"].push_back({{"extras", {{"reflectance", {{"nir", 0.5}}}}}});
                },
                "material \"whte\": extras hold no reflectance for band \"nir\""},
        BadGltf{"PrimitiveWithoutBands",
                [](Json& g) {
                    g["materials"][0]["extras"]["reflectance"]["nir"] = 0.5;
                    g["meshes"][0]["primitives"][0].erase("material");
                },
                "material \"default\": a primitive without a material has no reflectance for the "
                "named bands"},
        BadGltf{"BandIsText",
                [](Json& g) { g["materials"][0]["extras"]["reflectance"]["nir"] = "half"; },
                "material \"whte\": reflectance of band \"nir\" is no number"},
        BadGltf{"BandAboveOne",
                [](Json& g) { g["materials"][0]["extras"]["reflectance"]["nir"] = 1.5; },
                "material \"whte\": reflectance 1.50 is above 1"}),
    [](const auto& test) { return test.param.name; });

TEST_F(ReadGltf, RefusesEveryTruncationOfABinaryFile) {
    const std::string whole = glb(triangle_gltf());

    for (std::size_t size = 0; size < whole.size(); ++size) {
        const std::string error = folder.error_of("a.glb", whole.substr(0, size));
        EXPECT_THAT(error, HasSubstr("a.glb: ")) << size << " bytes";
    }
    EXPECT_EQ(folder.error_of("a.glb", whole.substr(0, 100)), "a.glb: glb header: announces " +
                                                                  std::to_string(whole.size()) +
                                                                  " bytes, the file holds 100");
}

TEST_F(ReadGltf, NeverCrashesOnADamagedFile) {
    const std::string whole = glb(triangle_gltf({{"name", "a"}}));

    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const char damage : {'\0', '"', '9', '\xff', '['}) {
            std::string damaged = whole;
            damaged[i] = damage;
            folder.error_of("a.glb", damaged);  // throws InputError or nothing
        }
    }
}

TEST_F(ReadGltf, RefusesWhatIsNotGltf) {
    EXPECT_EQ(folder.error_of("a.gltf", ""), "a.gltf: is empty");
    EXPECT_THAT(folder.error_of("a.gltf", "{hello"),
                HasSubstr("a.gltf: JSON: parse error at line 1"));
    EXPECT_THAT(folder.error_of("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"x\": 1e999}"),
                HasSubstr("a.gltf: JSON: number overflow"));
    EXPECT_THAT(folder.error_of("a.gltf", "{\"x\": NaN}"), HasSubstr("a.gltf: JSON: parse error"));
    EXPECT_EQ(folder.error_of("a.gltf", "[]"), "a.gltf: glTF: is not a JSON object");
    EXPECT_EQ(folder.error_of("a.gltf", "hello"),
              "a.gltf: glTF: starts neither as GLB nor as JSON");
    EXPECT_EQ(folder.error_of("a.glb", "\x89PNG"),
              "a.glb: glTF: starts neither as GLB nor as JSON");
    EXPECT_THAT(folder.error_of(folder.path() / "no.glb"), HasSubstr("no.glb: does not exist"));
}

/// A link was put there by whoever owns the folder: collections of large files consist of links.
TEST_F(ReadGltf, FollowsLinksWithinTheFolder) {
    Json gltf = triangle_gltf();
    gltf["buffers"][0]["uri"] = "scene/room.bin";
    folder.write("store/a.bin", std::string(36, '\0'));
    std::filesystem::create_directory_symlink(folder.path() / "store", folder.path() / "scene");
    std::filesystem::create_symlink("a.bin", folder.path() / "store/room.bin");

    EXPECT_EQ(folder.error_of(gltf), "");
}

TEST_F(ReadGltf, LeavesItsFolderByNoLinkEither) {
    Json gltf = triangle_gltf();
    gltf["buffers"][0]["uri"] = "link/../a.bin";
    folder.write("out/a.bin", std::string(36, '\0'));
    folder.write("out/deep/b.bin", "");
    folder.write("scene/room.gltf", gltf.dump());
    std::filesystem::create_directory_symlink("../out/deep", folder.path() / "scene/link");

    EXPECT_NE(folder.error_of(folder.path() / "scene/room.gltf"), "");

    folder.write("out/room.gltf", gltf.dump());
    EXPECT_EQ(folder.error_of(folder.path() / "scene/link/../room.gltf"), "")
        << "what the user names is where the kernel finds it";
}

TEST_F(ReadGltf, TellsOnceOfAPrimitiveWithoutFacesHoweverManyNodesShowIt) {
    Json gltf = triangle_gltf();
    auto& primitives = gltf["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[0]["mode"] = 0;
    gltf["nodes"] = Json(3, gltf["nodes"][0]);

    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.faces.size(), 3u);
    EXPECT_THAT(scene.warnings, ElementsAre("room.gltf: meshes/0/primitives/0: points and lines "
                                            "have no area, skipped"));
}

/// Each of them anew would take minutes.
TEST_F(ReadGltf, DecodesAnImageOnce) {
    Json gltf = triangle_gltf({{"name", "a"}});
    constexpr int kTextures = 1000;
    const std::string image = white_png(1000);  // easily large
    const std::vector<char> bytes(image.begin(), image.end());
    add_accessor(gltf, bytes, "SCALAR", 5121, 1);
    gltf["images"] = Json::array();
    gltf["textures"] = Json::array();
    gltf["materials"] = Json::array();
    for (int i = 0; i < kTextures; ++i) {
        gltf["images"].push_back({{"bufferView", 1}, {"mimeType", "image/png"}});
        gltf["textures"].push_back({{"source", i}});
        gltf["materials"].push_back(
            {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", i}}}});
    }

    const auto start = std::clock();
    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.materials[kTextures - 1].emission, std::vector(3, 1.0));
    EXPECT_LT(seconds_since(start), 20);
}

/// Of one pixel each; decoding whatever value a pixel may have takes twelve seconds.
TEST_F(ReadGltf, DecodesOnlyTheValuesThatAnImageHas) {
    Json gltf = triangle_gltf({{"name", "a"}});
    constexpr std::size_t kImages = 3000;
    // One row, stored; a byte more for each image, which no decoder looks at, makes another of it.
    const std::string row("\0\xff\xff\xff\xff\xff\xff", 7);
    const std::string image =
        png(1, 1, 16, std::string("\x78\x01\x01\x07\0\xf8\xff", 7) + row + "\0\0\0\0");
    const std::string bytes = image + std::string(kImages, '\0');
    add_accessor(gltf, std::vector<char>(bytes.begin(), bytes.end()), "SCALAR", 5121, 1);
    gltf["materials"] = Json::array();
    for (std::size_t i = 0; i < kImages; ++i) {
        gltf["bufferViews"].push_back({{"buffer", 1}, {"byteLength", image.size() + i}});
        gltf["images"].push_back({{"bufferView", 2 + i}, {"mimeType", "image/png"}});
        gltf["textures"].push_back({{"source", i}});
        gltf["materials"].push_back(
            {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", i}}}});
    }

    const auto start = std::clock();
    const Scene scene = folder.read(gltf);

    EXPECT_EQ(scene.materials[kImages - 1].emission, std::vector(3, 1.0));
    EXPECT_LT(seconds_since(start), 8);
}

/// glTF 2.0, sec. 4.4.3.3. tinygltf would copy it for each.
TEST_F(ReadGltf, RefusesASecondBufferInTheBinaryChunk) {
    Json gltf = triangle_gltf();
    gltf["buffers"].push_back({{"byteLength", 36}});
    EXPECT_EQ(folder.error_of("a.glb", glb(gltf)),
              "a.glb: buffers/1: has no uri, only the first buffer may lie in the binary chunk");

    gltf["buffers"][1]["uri"] = gltf["buffers"][0]["uri"];
    EXPECT_EQ(folder.error_of("a.glb", glb(gltf)), "");
}

TEST_F(ReadGltf, TakesNoLightsNameFromBeyondTheirNumber) {
    Json gltf = triangle_gltf();
    gltf["nodes"][0].erase("name");
    gltf["extensions"]["KHR_lights_punctual"]["lights"] =
        Json::array({{{"name", "sun"}, {"type", "directional"}}});
    auto& light = gltf["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"];
    for (const std::uint64_t index : {std::uint64_t{1}, ~std::uint64_t{0}}) {
        light = index;
        EXPECT_EQ(folder.read(gltf).lights_not_taken, 0u) << index;
    }
    light = -1;
    EXPECT_EQ(folder.read(gltf).lights_not_taken, 0u);
    light = 0.5;
    EXPECT_EQ(folder.read(gltf).lights_not_taken, 0u);
    light = 0;
    EXPECT_EQ(folder.read(gltf).lights_not_taken, 1u);
}

TEST_F(ReadGltf, DoesNotReadBuffersFromTheWorkingFolder) {
    Json gltf = triangle_gltf();
    gltf["buffers"][0]["uri"] = "room.bin";
    folder.write("elsewhere/room.bin", std::string(36, '\0'));
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path() / "elsewhere");

    const std::string error = folder.error_of(gltf);

    std::filesystem::current_path(before);
    EXPECT_EQ(error, "room.gltf: glTF: File not found : room.bin");
}

}  // namespace
}  // namespace hemirad::test::read_gltf_test
