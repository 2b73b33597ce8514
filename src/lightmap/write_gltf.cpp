#include "lightmap/write_gltf.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "errors.h"
#include "lightmap/atlas_file.h"
#include "lightmap/atomic_file.h"
#include "lightmap/base64.h"
#include "lightmap/tone.h"
#include "scene/bounds.h"
#include "scene/input_file.h"

namespace hemirad {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

// glTF 2.0, sec. 3.6, 3.7 and 4.4.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementBuffer = 34963;
constexpr int kLinear = 9729, kClampToEdge = 33071;
constexpr std::uint32_t kMagic = 0x46546C67, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kUnit = 4;  // bytes that chunks and numbers are aligned to

/// A vertex of the scene, where it lies in the lightmap, and its normal in thousandths.
using VertexKey = std::tuple<std::uint32_t, float, float, long, long, long>;

/// Of all that one object has in one material and one atlas.
struct Primitive {
    std::map<VertexKey, std::uint32_t> known;
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<std::uint32_t> indices;
};

/// A material of the scene as glTF lists it: once for each atlas that its light lies in.
struct LitMaterial {
    std::uint32_t material, atlas;

    auto operator<=>(const LitMaterial&) const = default;
};

using Primitives = std::map<LitMaterial, Primitive>;

/// Far from the origin floats would be too coarse; a node takes coordinates there in double.
glm::dvec3 root_of(const Bounds& bounds) {
    constexpr double kNear = 4;  // extents: two bits of a float's 24
    const glm::dvec3 middle = bounds.middle();
    return glm::length(middle) < kNear * bounds.diagonal() ? glm::dvec3(0) : middle;
}

void check_range(const Bounds& bounds, const glm::dvec3& root, const std::string& name) {
    const glm::dvec3 most = glm::max(glm::abs(bounds.least - root), glm::abs(bounds.most - root));
    const double largest = std::max({most.x, most.y, most.z});
    if (largest > double{std::numeric_limits<float>::max()})
        throw OutputError(name + ": a coordinate of " + number(largest) +
                          " m is beyond glTF's floats");
}

glm::dvec3 normal_of(const Scene& scene, const std::array<std::uint32_t, 3>& vertices) {
    const glm::dvec3& base = scene.positions[vertices[0]];
    const glm::dvec3 area =
        glm::cross(scene.positions[vertices[1]] - base, scene.positions[vertices[2]] - base);
    const double length = glm::length(area);
    return length > 0 ? area / length : glm::dvec3(0, 0, 1);
}

VertexKey key_of(std::uint32_t vertex, const glm::vec2& uv, const glm::vec3& normal) {
    constexpr float kFine = 1000;  // normals of coplanar triangles differ by rounding
    return {vertex,
            uv.x,
            uv.y,
            std::lround(kFine * normal.x),
            std::lround(kFine * normal.y),
            std::lround(kFine * normal.z)};
}

void add_triangle(const Scene& scene, const UvTriangle& triangle, const glm::dvec3& root,
                  Primitive& primitive) {
    const Face& face = scene.faces[triangle.face];
    std::array<std::uint32_t, 3> vertices{};
    for (std::size_t i = 0; i < 3; ++i) vertices[i] = face.vertices[triangle.corners[i]];
    const glm::vec3 normal(normal_of(scene, vertices));
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec2 uv(triangle.uvs[i]);
        const auto next = static_cast<std::uint32_t>(primitive.positions.size());
        const auto [at, is_new] =
            primitive.known.try_emplace(key_of(vertices[i], uv, normal), next);
        primitive.indices.push_back(at->second);
        if (!is_new) continue;
        primitive.positions.emplace_back(scene.positions[vertices[i]] - root);
        primitive.normals.push_back(normal);
        primitive.uvs.push_back(uv);
    }
}

std::map<std::uint32_t, Primitives> primitives_of(const Scene& scene,
                                                  const std::vector<UvTriangle>& triangles,
                                                  const glm::dvec3& root) {
    std::map<std::uint32_t, Primitives> objects;
    for (const UvTriangle& triangle : triangles) {
        const Face& face = scene.faces[triangle.face];
        add_triangle(scene, triangle, root, objects[face.object][{face.material, triangle.atlas}]);
    }
    return objects;
}

/// The binary buffer and what describes it.
class Buffer {
  public:
    int add_view(std::string_view bytes, int target = 0) {
        bytes_.append((kUnit - bytes_.size() % kUnit) % kUnit, '\0');
        Json view{{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
        if (target != 0) view["target"] = target;
        bytes_ += bytes;
        views_.push_back(view);
        return static_cast<int>(views_.size()) - 1;
    }

    template <class Value>
    int add(const std::vector<Value>& values, const char* type, int component, int target) {
        const std::string_view bytes(reinterpret_cast<const char*>(values.data()),
                                     values.size() * sizeof(Value));
        accessors_.push_back({{"bufferView", add_view(bytes, target)},
                              {"componentType", component},
                              {"count", values.size()},
                              {"type", type}});
        return static_cast<int>(accessors_.size()) - 1;
    }

    int add_positions(const std::vector<glm::vec3>& positions) {
        const int accessor = add(positions, "VEC3", kFloat, kArrayBuffer);
        const auto [least, most] = bounds_of(positions);
        accessors_.back()["min"] = {least.x, least.y, least.z};
        accessors_.back()["max"] = {most.x, most.y, most.z};
        return accessor;
    }

    const std::string& bytes() const { return bytes_; }
    const Json& views() const { return views_; }
    const Json& accessors() const { return accessors_; }

  private:
    std::string bytes_;
    Json views_ = Json::array(), accessors_ = Json::array();
};

Json spectrum(const std::vector<double>& values, const std::vector<std::string>& bands) {
    Json json = Json::object();
    for (std::size_t band = 0; band < bands.size(); ++band) json[bands[band]] = values[band];
    return json;
}

Json material_json(const Material& material, const std::vector<std::string>& bands,
                   std::uint32_t atlas, double intensity) {
    const ShownBands shown = shown_bands(bands.size());
    const auto shown_of = [&](const std::vector<double>& values) {
        return std::array{values[shown[0]], values[shown[1]], values[shown[2]]};
    };
    const auto [red, green, blue] = shown_of(material.reflectance);
    Json json{{"name", material.name},
              {"pbrMetallicRoughness",
               {{"baseColorFactor", {red, green, blue, 1}},
                {"metallicFactor", 0},
                {"roughnessFactor", 1}}}};
    auto emission = shown_of(material.emission);
    const double strength = std::max(1.0, *std::ranges::max_element(emission));
    for (double& radiance : emission) radiance /= strength;
    if (*std::ranges::max_element(emission) > 0) json["emissiveFactor"] = emission;
    if (strength > 1)
        json["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", strength}};
    json["extensions"]["MOZ_lightmap"] = {
        {"index", atlas}, {"texCoord", 1}, {"intensity", intensity}};
    if (bands != std::vector<std::string>{"R", "G", "B"})
        json["extras"] = {{"reflectance", spectrum(material.reflectance, bands)},
                          {"emission", spectrum(material.emission, bands)}};
    return json;
}

Json primitive_json(const Primitive& primitive, int material, Buffer& buffer) {
    const int positions = buffer.add_positions(primitive.positions);
    const int normals = buffer.add(primitive.normals, "VEC3", kFloat, kArrayBuffer);
    const int uvs = buffer.add(primitive.uvs, "VEC2", kFloat, kArrayBuffer);
    const int indices = buffer.add(primitive.indices, "SCALAR", kUnsignedInt, kElementBuffer);
    return {
        {"attributes",
         {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}, {"TEXCOORD_1", uvs}}},
        {"indices", indices},
        {"material", material}};
}

/// Arrays of a glTF.
struct Contents {
    Json nodes = Json::array(), meshes = Json::array(), materials = Json::array(),
         cameras = Json::array();
};

/// Nodes, meshes and materials, these in the scene's order as far as they are seen.
void add_objects(Contents& to, const Scene& scene, const Mesh& mesh,
                 const std::map<std::uint32_t, Primitives>& objects,
                 const std::vector<LightmapImage>& images, Buffer& buffer) {
    std::map<LitMaterial, int> materials;
    for (const auto& [object, primitives] : objects)
        for (const auto& [material, primitive] : primitives) materials[material] = 0;
    for (int next = 0; auto& [material, index] : materials) {
        const auto& [in_scene, atlas] = material;
        to.materials.push_back(
            material_json(mesh.materials[in_scene], mesh.bands, atlas, images[atlas].intensity));
        index = next++;
    }
    for (const auto& [object, primitives] : objects) {
        Json list = Json::array();
        for (const auto& [material, primitive] : primitives)
            list.push_back(primitive_json(primitive, materials[material], buffer));
        to.nodes.push_back({{"name", scene.objects[object]}, {"mesh", to.meshes.size()}});
        to.meshes.push_back({{"name", scene.objects[object]}, {"primitives", list}});
    }
}

void add_cameras(Contents& to, const std::vector<Camera>& cameras, const glm::dvec3& root) {
    for (const Camera& camera : cameras) {
        constexpr double kNear = 1e-3;  // m; a viewer's, we have no near plane
        const glm::dvec3 right = glm::cross(camera.forward, camera.up), &up = camera.up;
        const glm::dvec3 back = -camera.forward, eye = camera.eye - root;
        Json perspective{{"yfov", camera.yfov}, {"znear", kNear}};
        if (camera.aspect > 0) perspective["aspectRatio"] = camera.aspect;
        to.nodes.push_back({{"name", camera.name},
                            {"camera", to.cameras.size()},
                            {"matrix",
                             {right.x, right.y, right.z, 0, up.x, up.y, up.z, 0, back.x, back.y,
                              back.z, 0, eye.x, eye.y, eye.z, 1}}});
        to.cameras.push_back(
            {{"name", camera.name}, {"type", "perspective"}, {"perspective", perspective}});
    }
}

/// All nodes hang from one that stands at the root, unless that is the origin.
Json roots_of(Contents& to, const glm::dvec3& root) {
    Json nodes = Json::array();
    for (std::size_t i = 0; i < to.nodes.size(); ++i) nodes.push_back(i);
    if (root == glm::dvec3(0)) return nodes;
    to.nodes.push_back({{"name", "far from the origin"},
                        {"translation", {root.x, root.y, root.z}},
                        {"children", nodes}});
    return Json::array({to.nodes.size() - 1});
}

/// One at a time: a new key of the document moves the others.
void add_contents(Json& gltf, Contents contents, const glm::dvec3& root) {
    const Json nodes = roots_of(contents, root);
    gltf["scene"] = 0;
    gltf["scenes"] = Json::array({Json{{"nodes", nodes}}});
    gltf["nodes"] = std::move(contents.nodes);
    gltf["meshes"] = std::move(contents.meshes);
    gltf["materials"] = std::move(contents.materials);
    if (!contents.cameras.empty()) gltf["cameras"] = std::move(contents.cameras);
}

/// A texture an atlas, of its number.
void add_lightmaps(Json& gltf, const std::vector<LightmapImage>& images, Buffer& buffer) {
    const Json sampler{{"magFilter", kLinear},
                       {"minFilter", kLinear},
                       {"wrapS", kClampToEdge},
                       {"wrapT", kClampToEdge}};
    Json list = Json::array(), textures = Json::array();
    for (std::uint32_t atlas = 0; atlas < images.size(); ++atlas) {
        const std::string name = atlas_file("lightmap", atlas).string();
        const int view = buffer.add_view(images[atlas].png);
        list.push_back({{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}});
        textures.push_back({{"name", name}, {"sampler", 0}, {"source", atlas}});
    }
    gltf["images"] = std::move(list);
    gltf["samplers"] = Json::array({sampler});
    gltf["textures"] = std::move(textures);
}

void add_extensions(Json& gltf) {
    Json used = Json::array({"MOZ_lightmap"});
    for (const Json& material : gltf["materials"])
        for (const auto& [name, extension] : material["extensions"].items())
            if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    gltf["extensionsUsed"] = used;
}

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_words(std::ostream& stream, std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words)
        stream.write(reinterpret_cast<const char*>(&word), sizeof word);
}

std::string in_units(std::string bytes, char fill) {
    bytes.append((kUnit - bytes.size() % kUnit) % kUnit, fill);
    return bytes;
}

/// glTF 2.0, sec. 4.4.
void write_binary(std::ostream& stream, Json gltf, const std::string& bytes,
                  const std::string& name) {
    const std::string binary = in_units(bytes, '\0');
    gltf["buffers"] = Json::array({Json{{"byteLength", bytes.size()}}});
    const std::string json = in_units(text_of(gltf), ' ');
    const std::size_t length = 12 + 8 + json.size() + 8 + binary.size();
    if (length > std::numeric_limits<std::uint32_t>::max())
        throw OutputError(name + ": a .glb holds no more than 4 GiB");
    write_words(stream, {kMagic, 2, static_cast<std::uint32_t>(length)});
    write_words(stream, {static_cast<std::uint32_t>(json.size()), kJsonChunk});
    stream << json;
    write_words(stream, {static_cast<std::uint32_t>(binary.size()), kBinaryChunk});
    stream << binary;
}

void write_text(std::ostream& stream, Json gltf, const std::string& bytes) {
    const Json buffer{{"byteLength", bytes.size()},
                      {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
    gltf["buffers"] = Json::array({buffer});
    stream << text_of(gltf) << '\n';
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const Scene& scene, const Mesh& mesh,
                const std::vector<Camera>& cameras, const std::vector<UvTriangle>& triangles,
                const std::vector<LightmapImage>& images, const std::filesystem::path& exr) {
    Buffer buffer;
    const Bounds bounds = bounds_of(scene);
    const glm::dvec3 root = root_of(bounds);
    check_range(bounds, root, path.string());
    Json gltf{{"asset", {{"version", "2.0"}, {"generator", "hemirad"}}}};
    gltf["asset"]["extras"]["hemirad"] = {{"exr", exr.generic_string()},
                                          {"atlases", images.size()}};
    Contents contents;
    add_objects(contents, scene, mesh, primitives_of(scene, triangles, root), images, buffer);
    add_cameras(contents, cameras, root);
    add_contents(gltf, std::move(contents), root);
    add_lightmaps(gltf, images, buffer);
    add_extensions(gltf);
    gltf["accessors"] = buffer.accessors();
    gltf["bufferViews"] = buffer.views();
    write_atomically(path, [&](std::ostream& stream) {
        if (path.extension() == ".glb")
            write_binary(stream, gltf, buffer.bytes(), path.string());
        else
            write_text(stream, gltf, buffer.bytes());
    });
}

}  // namespace hemirad
