#include "scene/limit_reflectance.h"

#include <algorithm>
#include <sstream>

#include "scene/short_text.h"

namespace hemirad::meshing {
namespace {

std::string name_of(const Scene& scene, std::size_t material) {
    const std::string& name = scene.materials[material].name;
    return name.empty() ? '#' + std::to_string(material) : '"' + name + '"';
}

std::string warning(const Scene& scene, double limit, const std::vector<std::size_t>& limited) {
    constexpr std::size_t kNamed = 20;
    std::ostringstream line;
    line << scene.file << ": reflectance limited to " << limit << " in material";
    if (limited.size() > 1) line << 's';
    line << ' ' << names_in_short(limited.size(), kNamed, [&](std::size_t i) {
        return name_of(scene, limited[i]);
    });
    return line.str();
}

}  // namespace

void limit_reflectance(const Scene& scene, double limit, Mesh& mesh) {
    std::vector<bool> used(scene.materials.size(), false);
    for (const Face& face : scene.faces) used[face.material] = true;
    std::vector<std::size_t> limited;
    mesh.materials = scene.materials;
    for (std::size_t m = 0; m < mesh.materials.size(); ++m) {
        auto& reflectance = mesh.materials[m].reflectance;
        if (used[m] && std::ranges::any_of(reflectance, [&](double r) { return r > limit; }))
            limited.push_back(m);
        for (double& r : reflectance) r = std::min(r, limit);
    }
    if (!limited.empty()) mesh.warnings.push_back(warning(scene, limit, limited));
}

}  // namespace hemirad::meshing
