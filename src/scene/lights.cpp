#include "scene/lights.h"

#include <algorithm>
#include <map>
#include <set>

namespace hemirad {
namespace {

bool emits(const Mesh& mesh, const Surface& surface) {
    return std::ranges::any_of(mesh.materials[surface.material].emission,
                               [](double radiance) { return radiance > 0; });
}

bool several_objects_emit(const Mesh& mesh) {
    std::set<std::string> names;
    for (const Surface& surface : mesh.surfaces)
        if (emits(mesh, surface)) names.insert(mesh.objects[surface.object]);
    return names.size() > 1;
}

}  // namespace

LightGroups group_lights(const Mesh& mesh, Lights lights) {
    LightGroups groups;
    if (lights == Lights::together) return groups;
    const bool by_object = lights == Lights::separate && several_objects_emit(mesh);
    std::map<std::string, std::uint32_t> known;
    groups.of_surface.assign(mesh.surfaces.size(), kNoLight);
    for (std::size_t s = 0; s < mesh.surfaces.size(); ++s) {
        const Surface& surface = mesh.surfaces[s];
        if (!emits(mesh, surface)) continue;
        const std::string& name =
            by_object ? mesh.objects[surface.object] : mesh.materials[surface.material].name;
        const auto next = static_cast<std::uint32_t>(groups.names.size());
        const auto [light, is_new] = known.try_emplace(name, next);
        if (is_new) groups.names.push_back(name);
        groups.of_surface[s] = light->second;
    }
    return groups;
}

}  // namespace hemirad
