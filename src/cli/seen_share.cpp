#include "cli/seen_share.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/first_hit.h"

namespace hemirad {
namespace {

constexpr std::size_t kLookers = 256, kLooks = 32;
// A ray may meet the patch that it ends on, or a neighbour, before its end by as much.
constexpr double kNearEnd = 1e-6;

// Two triangles a patch: fronts hide, as they do in a solve.
Scene triangles_of(const Mesh& mesh) {
    Scene scene;
    scene.positions = mesh.vertices;
    for (const Patch& patch : mesh.patches) {
        const auto [a, b, c, d] = patch.corners;
        scene.faces.push_back({.vertices = {a, b, c}});
        if (!patch.is_triangle()) scene.faces.push_back({.vertices = {a, c, d}});
    }
    return scene;
}

bool sees(const Mesh& mesh, const FirstHit& first_hit, const Patch& from, const Patch& to) {
    const glm::dvec3 origin = mesh.centroid(from), direction = mesh.centroid(to) - origin;
    if (!(glm::dot(direction, mesh.normal(from)) > 0)) return false;
    if (!(glm::dot(direction, mesh.normal(to)) < 0)) return false;
    const auto hit = first_hit(origin, direction);
    return !hit || hit->distance > 1 - kNearEnd;
}

// Of as many as there are, evenly spread: by the golden ratio, whose multiples leave no gaps.
std::size_t spread(std::size_t i, std::size_t count) {
    constexpr double kGolden = 0.6180339887498949;
    double whole = 0;
    return std::min(count - 1, static_cast<std::size_t>(
                                   std::modf(kGolden * static_cast<double>(i + 1), &whole) *
                                   static_cast<double>(count)));
}

}  // namespace

double seen_share(const Mesh& mesh) {
    const Scene scene = triangles_of(mesh);
    const FirstHit first_hit(scene);
    const std::size_t patches = mesh.patches.size();
    std::size_t seen = 0;
    for (std::size_t looker = 0; looker < kLookers; ++looker) {
        const Patch& from = mesh.patches[looker * patches / kLookers];
        for (std::size_t look = 0; look < kLooks; ++look)
            seen +=
                sees(mesh, first_hit, from, mesh.patches[spread(looker * kLooks + look, patches)]);
    }
    return static_cast<double>(seen) / (kLookers * kLooks);
}

}  // namespace hemirad
