#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/camera.h"
#include "scene/gltf_nodes.h"

namespace hemirad {
namespace {

double number_in(const GltfFile& gltf, const std::string& path, const Json& json, const char* key,
                 double missing) {
    const auto value = json.find(key);
    if (value == json.end()) return missing;
    if (value->is_number() && std::isfinite(value->get<double>()) && value->get<double>() > 0)
        return value->get<double>();
    fail(gltf.file, path, std::string(key) + " is no number above 0");
}

std::string name_of(const GltfFile& gltf, std::size_t node, std::size_t camera) {
    for (const std::string& name : {gltf.model.nodes[node].name, gltf.model.cameras[camera].name})
        if (!name.empty()) {
            check_name(gltf.file, "camera", name);
            return printable(name);
        }
    return "camera" + std::to_string(camera);
}

glm::dvec3 direction(const glm::dvec3& along) { return along / glm::length(along); }

// glTF 2.0, sec. 3.10: a camera looks along its node's -z, +y is up; scale does not matter to it.
void add_camera(const GltfFile& gltf, const PlacedNode& node, std::vector<Camera>& cameras) {
    if (gltf.model.nodes[node.node].camera < 0) return;
    const auto index = static_cast<std::size_t>(gltf.model.nodes[node.node].camera);
    const std::string path = "cameras/" + std::to_string(index);
    const Json& json = gltf.json["cameras"][index];
    const auto perspective = json.find("perspective");
    if (perspective == json.end()) return;

    Camera camera{name_of(gltf, node.node, index)};
    camera.yfov = number_in(gltf, path, *perspective, "yfov", camera.yfov);
    camera.aspect = number_in(gltf, path, *perspective, "aspectRatio", 0);
    camera.eye = glm::dvec3(node.world_from_node[3]);
    camera.forward = -direction(glm::dvec3(node.world_from_node[2]));
    const glm::dvec3 up(node.world_from_node[1]);
    camera.up = direction(up - glm::dot(up, camera.forward) * camera.forward);
    const glm::dvec3 all = camera.eye + camera.forward + camera.up;
    if (!(camera.yfov < std::numbers::pi) || !std::isfinite(all.x + all.y + all.z))
        fail(gltf.file, path, "its node or its yfov shows nothing");
    cameras.push_back(camera);
}

}  // namespace

std::vector<Camera> read_cameras(const std::filesystem::path& scene) {
    std::vector<Camera> cameras;
    if (!is_gltf(scene)) return cameras;
    const InputFile file = read_input_file(scene);
    const GltfFile gltf = load_gltf(file);
    for (const PlacedNode& node : place_nodes(gltf)) add_camera(gltf, node, cameras);
    return cameras;
}

}  // namespace hemirad
