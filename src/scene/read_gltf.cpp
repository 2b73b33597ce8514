#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "scene/gltf_nodes.h"
#include "scene/input_file.h"
#include "scene/quantum.h"
#include "scene/short_text.h"

namespace hemirad {
namespace {

/// Corners and vertices of all nodes together: some 10 GB. A mesh is small in a file whose nodes
/// show it a million times, and so are primitives that share their accessors.
constexpr std::size_t kMostPlaced = 100'000'000;
/// Of those, what a file may show that does not hold it: a corner takes a byte at least.
constexpr std::size_t kMostMultiplied = 10'000'000;

struct Builder {
    const GltfFile& gltf;
    Scene scene = {};
    std::optional<std::uint32_t> default_material = {};
    std::map<int, std::vector<std::size_t>> primitives = {};  ///< of meshes, those with faces
    std::set<std::string> told = {};                          ///< what is not read
    std::vector<double> quanta = {};  ///< m, of each of the scene's positions
};

/// Of what is not read, with the first place in the file that has it.
void warn_once(Builder& builder, const std::string& what, const std::string& reason,
               const std::string& path) {
    if (builder.told.insert(what).second) warn(builder.scene, what, reason + " (" + path + ")");
}

std::string node_path(std::size_t node) { return "nodes/" + std::to_string(node); }

glm::dquat rotation(const GltfFile& gltf, std::size_t node) {
    const auto& q = gltf.model.nodes[node].rotation;
    if (q.empty()) return {1, 0, 0, 0};
    const glm::dquat quaternion(q[3], q[0], q[1], q[2]);
    const double length = glm::length(quaternion);
    if (!(length > 0 && std::isfinite(length))) {
        fail(gltf.file, node_path(node), "its rotation is not a quaternion");
    }
    return quaternion / length;
}

glm::dmat4 parent_from_node(const GltfFile& gltf, std::size_t index) {
    const auto& node = gltf.model.nodes[index];
    if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
    glm::dmat4 result = glm::mat4_cast(rotation(gltf, index));
    for (int axis = 0; axis < 3 && !node.scale.empty(); ++axis) {
        result[axis] *= node.scale[static_cast<std::size_t>(axis)];
    }
    if (!node.translation.empty()) {
        result[3] = glm::dvec4(glm::make_vec3(node.translation.data()), 1);
    }
    return result;
}

/// By how much an axis grows at most.
double largest_growth(const glm::dmat4& matrix) {
    double largest = 0;
    for (int row = 0; row < 3; ++row)
        largest = std::max(largest, std::abs(matrix[0][row]) + std::abs(matrix[1][row]) +
                                        std::abs(matrix[2][row]));
    return largest;
}

/// Places are doubles, unless they are floats to the last digit: such was the exporter's
/// arithmetic.
double place_quantum(const glm::dmat4& parent_from_node) {
    double quantum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double at = parent_from_node[3][axis];
        if (is_float_in_full(at)) quantum = std::max(quantum, half_float_ulp(at));
    }
    return quantum;
}

/// glTF 2.0, sec. 3.5.2: the nodes form trees; a node has at most one parent.
std::vector<int> parents(const GltfFile& gltf) {
    std::vector<int> parent(gltf.model.nodes.size(), -1);
    for (std::size_t i = 0; i < parent.size(); ++i) {
        for (const int child : gltf.model.nodes[i].children) {
            int& known = parent[static_cast<std::size_t>(child)];
            if (known >= 0) {
                fail(gltf.file, node_path(static_cast<std::size_t>(child)),
                     "is the child of two nodes");
            }
            known = static_cast<int>(i);
        }
    }
    return parent;
}

std::vector<std::size_t> roots(const std::vector<int>& parent) {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < parent.size(); ++i) {
        if (parent[i] < 0) result.push_back(i);
    }
    return result;
}

/// With one parent to a node, what no root leads to is a cycle.
void check_cycles(const GltfFile& gltf, const std::vector<int>& parent) {
    std::vector<std::size_t> open = roots(parent);
    std::vector<bool> reached(parent.size());
    while (!open.empty()) {
        const std::size_t node = open.back();
        open.pop_back();
        reached[node] = true;
        const auto& children = gltf.model.nodes[node].children;
        open.insert(open.end(), children.begin(), children.end());
    }
    const auto stray = std::find(reached.begin(), reached.end(), false);
    if (stray == reached.end()) return;
    fail(gltf.file, node_path(static_cast<std::size_t>(stray - reached.begin())),
         "is its own ancestor");
}

/// The nodes to start from: the default scene's, else the first scene's, else all roots.
std::vector<std::size_t> scene_nodes(const GltfFile& gltf, const std::vector<int>& parent) {
    const auto& model = gltf.model;
    if (model.defaultScene < 0) return roots(parent);
    const auto& nodes = model.scenes[static_cast<std::size_t>(model.defaultScene)].nodes;
    std::vector<std::size_t> result(nodes.begin(), nodes.end());
    std::vector<bool> seen(parent.size());
    for (const std::size_t node : result) {
        if (parent[node] >= 0) fail(gltf.file, node_path(node), "is no root, but a scene's node");
        if (seen[node]) fail(gltf.file, node_path(node), "is twice in the scene");
        seen[node] = true;
    }
    return result;
}

}  // namespace

std::vector<PlacedNode> place_nodes(const GltfFile& gltf) {
    const std::vector<int> parent = parents(gltf);
    check_cycles(gltf, parent);
    std::vector<PlacedNode> open, placed;
    const auto push = [&](const auto& nodes, const PlacedNode& above) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            const auto index = static_cast<std::size_t>(*node);
            const glm::dmat4 in_parent = parent_from_node(gltf, index);
            open.push_back(
                {index, above.world_from_node * in_parent,
                 above.quantum + largest_growth(above.world_from_node) * place_quantum(in_parent)});
        }
    };
    push(scene_nodes(gltf, parent), PlacedNode{0, glm::dmat4(1)});
    while (!open.empty()) {
        placed.push_back(open.back());
        open.pop_back();
        const PlacedNode node = placed.back();
        push(gltf.model.nodes[node.node].children, node);
    }
    return placed;
}

namespace {

std::uint32_t material_index(Builder& builder, const tinygltf::Primitive& primitive) {
    if (primitive.material >= 0) return static_cast<std::uint32_t>(primitive.material);
    if (!builder.default_material) {
        builder.default_material = static_cast<std::uint32_t>(builder.scene.materials.size());
        builder.scene.materials.push_back(default_gltf_material(builder.gltf, builder.scene));
    }
    return *builder.default_material;
}

std::uint32_t add_object(Builder& builder, std::size_t node) {
    const auto& source = builder.gltf.model.nodes[node];
    const auto& mesh = builder.gltf.model.meshes[static_cast<std::size_t>(source.mesh)];
    const std::string& name = source.name.empty() ? mesh.name : source.name;
    check_name(builder.gltf.file, "object", name);
    builder.scene.objects.push_back(name.empty() ? "node" + std::to_string(node) : printable(name));
    return static_cast<std::uint32_t>(builder.scene.objects.size() - 1);
}

/// The first of the accessor's vertices in the scene, and how many there are.
struct VertexRange {
    std::size_t first, count;
};

VertexRange add_positions(Builder& builder, const PlacedNode& node, int accessor) {
    const std::vector<double> values = read_accessor(builder.gltf, accessor, 3);
    auto& positions = builder.scene.positions;
    const VertexRange range{positions.size(), values.size() / 3};
    if (range.first + range.count > std::numeric_limits<std::uint32_t>::max()) {
        fail(builder.gltf.file, node_path(node.node), "the scene has too many vertices");
    }
    const double growth = largest_growth(node.world_from_node);
    for (std::size_t i = 0; i < range.count; ++i) {
        const glm::dvec4 local(glm::make_vec3(&values[3 * i]), 1);
        const glm::dvec3 world(node.world_from_node * local);
        if (!std::isfinite(world.x + world.y + world.z)) {
            fail(builder.gltf.file, node_path(node.node),
                 "vertex " + std::to_string(i) + " is not finite");
        }
        positions.push_back(world);
        const double largest = std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)});
        builder.quanta.push_back(node.quantum + growth * half_float_ulp(largest));
    }
    return range;
}

std::vector<std::size_t> corner_sequence(const Builder& builder, const std::string& path,
                                         const tinygltf::Primitive& primitive, std::size_t count) {
    if (primitive.indices < 0) {
        std::vector<std::size_t> sequence(count);
        std::iota(sequence.begin(), sequence.end(), 0);
        return sequence;
    }
    const auto& accessor =
        builder.gltf.model.accessors[static_cast<std::size_t>(primitive.indices)];
    const int type = accessor.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
        fail(builder.gltf.file, path, "its indices are not unsigned integers");
    }
    std::vector<std::size_t> sequence;
    for (const double index : read_accessor(builder.gltf, primitive.indices, 1)) {
        if (!(index < double(count))) {
            fail(builder.gltf.file, path,
                 "vertex index " + std::to_string(static_cast<std::uint64_t>(index)) +
                     " is out of range, it has " + std::to_string(count) + " positions");
        }
        sequence.push_back(static_cast<std::size_t>(index));
    }
    return sequence;
}

using Triangle = std::array<std::size_t, 3>;

/// Corners of triangle `i` as positions in the sequence, glTF 2.0, sec. 3.7.2.1.
Triangle triangle_corners(int mode, std::size_t i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {i, i + 1 + i % 2, i + 2 - i % 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {i + 1, i + 2, 0};
    return {3 * i, 3 * i + 1, 3 * i + 2};
}

std::size_t triangle_count(const Builder& builder, const std::string& path, int mode,
                           std::size_t corners) {
    if (mode != TINYGLTF_MODE_TRIANGLES) return corners < 3 ? 0 : corners - 2;
    if (corners % 3 != 0) {
        fail(builder.gltf.file, path, std::to_string(corners) + " corners make no triangles");
    }
    return corners / 3;
}

/// True where a primitive brings faces.
bool has_faces(Builder& builder, const std::string& path, const tinygltf::Primitive& primitive) {
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN) {
        fail(builder.gltf.file, path, "mode " + std::to_string(primitive.mode));
    }
    if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        warn(builder.scene, path, "points and lines have no area, skipped");
        return false;
    }
    if (primitive.attributes.contains("POSITION")) return true;
    warn(builder.scene, path, "has no positions, skipped");
    return false;
}

struct PlacedPrimitive {
    const tinygltf::Primitive& source;
    std::string path;
    std::uint32_t object;
    VertexRange vertices;
    bool mirrored;
};

/// Elements that an accessor announces and may hold: what it lacks is told when it is read.
std::size_t element_count(const tinygltf::Model& model, int index) {
    const auto& accessor = model.accessors[static_cast<std::size_t>(index)];
    const auto held = [&](int view, std::size_t count) {
        if (view < 0) return count;
        return std::min(count, model.bufferViews[static_cast<std::size_t>(view)].byteLength);
    };
    const auto& sparse = accessor.sparse;
    return held(accessor.bufferView, accessor.count) +
           (sparse.isSparse
                ? held(sparse.indices.bufferView, static_cast<std::size_t>(sparse.count))
                : 0);
}

/// Of the mesh.
std::size_t placed_count(const GltfFile& gltf, const tinygltf::Mesh& mesh) {
    std::set<int> positions;
    std::size_t count = 0;
    for (const auto& primitive : mesh.primitives) {
        const auto position = primitive.attributes.find("POSITION");
        if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end())
            continue;
        const std::size_t vertices = element_count(gltf.model, position->second);
        if (positions.insert(position->second).second) count += vertices;
        count += primitive.indices < 0 ? vertices : element_count(gltf.model, primitive.indices);
    }
    return count;
}

/// Before memory is asked for.
void check_placed(const GltfFile& gltf, const std::vector<PlacedNode>& nodes) {
    std::map<int, std::size_t> of_mesh;
    std::size_t count = 0;
    for (const PlacedNode& node : nodes) {
        const int mesh = gltf.model.nodes[node.node].mesh;
        if (mesh < 0) continue;
        const auto [entry, is_new] = of_mesh.try_emplace(mesh, 0);
        if (is_new)
            entry->second = placed_count(gltf, gltf.model.meshes[static_cast<std::size_t>(mesh)]);
        count += entry->second;
    }
    std::size_t bytes = 0;
    for (const auto& buffer : gltf.model.buffers) bytes += buffer.data.size();
    const std::size_t most = std::min(kMostPlaced, kMostMultiplied + bytes);
    if (count <= most) return;
    fail(gltf.file, "nodes",
         "show meshes of " + std::to_string(count) + " vertices and corners, more than the " +
             std::to_string(most) + " that are read of " + std::to_string(bytes) + " bytes");
}

/// TEXCOORD_1 of each vertex: by a habit of exporters where it lies in a lightmap. None where the
/// primitive has none.
std::vector<glm::dvec2> read_lightmap_uvs(const Builder& builder,
                                          const PlacedPrimitive& primitive) {
    const auto attribute = primitive.source.attributes.find("TEXCOORD_1");
    if (attribute == primitive.source.attributes.end()) return {};
    const std::vector<double> values = read_accessor(builder.gltf, attribute->second, 2);
    if (values.size() != 2 * primitive.vertices.count) {
        fail(builder.gltf.file, primitive.path,
             "has " + std::to_string(values.size() / 2) + " TEXCOORD_1 for " +
                 std::to_string(primitive.vertices.count) + " positions");
    }
    std::vector<glm::dvec2> uvs;
    for (std::size_t i = 0; i < values.size(); i += 2) {
        uvs.emplace_back(values[i], values[i + 1]);
        if (std::isfinite(values[i] + values[i + 1])) continue;
        fail(builder.gltf.file, primitive.path,
             "TEXCOORD_1 " + std::to_string(i / 2) + " is not finite");
    }
    return uvs;
}

void add_faces(Builder& builder, const PlacedPrimitive& primitive) {
    const int mode = primitive.source.mode;
    const auto sequence =
        corner_sequence(builder, primitive.path, primitive.source, primitive.vertices.count);
    const std::size_t count = triangle_count(builder, primitive.path, mode, sequence.size());
    const std::uint32_t material = count > 0 ? material_index(builder, primitive.source) : 0;
    const auto uvs = read_lightmap_uvs(builder, primitive);
    for (std::size_t i = 0; i < count; ++i) {
        Face face{{}, material, primitive.object};
        Triangle corners = triangle_corners(mode, i);
        if (primitive.mirrored) std::swap(corners[1], corners[2]);
        for (const std::size_t corner : corners) {
            face.vertices.push_back(
                static_cast<std::uint32_t>(primitive.vertices.first + sequence[corner]));
            if (!uvs.empty()) face.lightmap_uvs.push_back(uvs[sequence[corner]]);
        }
        builder.scene.faces.push_back(std::move(face));
    }
}

std::string primitive_path(int mesh, std::size_t primitive) {
    return "meshes/" + std::to_string(mesh) + "/primitives/" + std::to_string(primitive);
}

/// The mesh's primitives that have faces. The others are told of once, however many nodes show
/// them.
const std::vector<std::size_t>& primitives_of(Builder& builder, int mesh) {
    const auto [entry, is_new] = builder.primitives.try_emplace(mesh);
    if (!is_new) return entry->second;
    const auto& all = builder.gltf.model.meshes[static_cast<std::size_t>(mesh)].primitives;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::string path = primitive_path(mesh, i);
        if (!has_faces(builder, path, all[i])) continue;
        entry->second.push_back(i);
        if (all[i].attributes.contains("COLOR_0"))
            warn_once(builder, "COLOR_0",
                      "vertex colours are not read, faces have their material's", path);
    }
    return entry->second;
}

void add_mesh(Builder& builder, const PlacedNode& node) {
    const auto& source = builder.gltf.model.nodes[node.node];
    if (source.mesh < 0) return;
    static const Json::json_pointer kInstances("/extensions/EXT_mesh_gpu_instancing");
    if (builder.gltf.json["nodes"][node.node].contains(kInstances))
        warn_once(builder, "EXT_mesh_gpu_instancing",
                  "instances are not read, a node shows its mesh once", node_path(node.node));
    if (source.skin >= 0) warn(builder.scene, node_path(node.node), "is read without its skin");
    const bool mirrored = glm::determinant(glm::dmat3(node.world_from_node)) < 0;
    const std::uint32_t object = add_object(builder, node.node);
    const auto& primitives =
        builder.gltf.model.meshes[static_cast<std::size_t>(source.mesh)].primitives;
    std::map<int, VertexRange> ranges;  // primitives of a mesh often share their positions
    for (const std::size_t i : primitives_of(builder, source.mesh)) {
        const int accessor = primitives[i].attributes.at("POSITION");
        if (!ranges.contains(accessor)) {
            ranges[accessor] = add_positions(builder, node, accessor);
        }
        add_faces(builder, {primitives[i], primitive_path(source.mesh, i), object, ranges[accessor],
                            mirrored});
    }
}

/// Of the node, whose extension is as its file has it: unchecked. Nothing where it has no light.
std::optional<std::string> punctual_light(const GltfFile& gltf, std::size_t node) {
    const Json& json = gltf.json["nodes"][node];
    if (!json.contains(Json::json_pointer("/extensions/KHR_lights_punctual/light"))) return {};
    const Json& light = json["extensions"]["KHR_lights_punctual"]["light"];
    const Json::json_pointer at("/extensions/KHR_lights_punctual/lights");
    static const Json kNone = Json::array();
    const Json& lights = gltf.json.contains(at) ? gltf.json[at] : kNone;
    if (!light.is_number_unsigned() || !lights.is_array()) return {};
    const auto index = light.get<std::uint64_t>();
    if (index >= lights.size()) return {};
    const std::string& name = gltf.model.nodes[node].name;
    if (!name.empty()) return name;
    const auto own = lights[index].find("name");
    const bool named = own != lights[index].end() && own->is_string();
    return named ? own->get<std::string>() : "light" + std::to_string(index);
}

/// Points, spots and suns have no faces, of which alone light comes.
void warn_of_lights(Builder& builder, const std::vector<PlacedNode>& nodes) {
    constexpr std::uint32_t kNamed = 3;
    std::uint32_t& count = builder.scene.lights_not_taken;
    std::vector<std::string> first;
    for (const PlacedNode& node : nodes)
        if (const auto name = punctual_light(builder.gltf, node.node); name && count++ < kNamed)
            first.push_back(in_quotes(*name));
    if (count == 0) return;
    const auto names = names_in_short(count, kNamed, [&](std::size_t i) { return first[i]; });
    warn(builder.scene, "KHR_lights_punctual",
         (count == 1 ? "a light (" : std::to_string(count) + " lights (") + names +
             (count == 1 ? ") is" : ") are") + " not taken: light comes from emissive faces");
}

/// Of the positions that faces use: buffers hold others, too.
double quantum_of(const Builder& builder) {
    double quantum = 0;
    for (const Face& face : builder.scene.faces)
        for (const std::uint32_t v : face.vertices) quantum = std::max(quantum, builder.quanta[v]);
    return quantum;
}

}  // namespace

Scene read_gltf(const InputFile& file) {
    const GltfFile gltf = load_gltf(file);
    Builder builder{gltf};
    builder.scene.file = file.name;
    builder.scene.side_files.assign(gltf.side_files.begin(), gltf.side_files.end());
    read_gltf_materials(gltf, builder.scene);
    const auto nodes = place_nodes(gltf);
    check_placed(gltf, nodes);
    for (const PlacedNode& node : nodes) add_mesh(builder, node);
    builder.scene.quantum = quantum_of(builder);
    warn_of_lights(builder, nodes);
    return std::move(builder.scene);
}

}  // namespace hemirad
