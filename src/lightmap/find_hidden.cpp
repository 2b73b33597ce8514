#include "lightmap/find_hidden.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>

#include "scene/disjoint_sets.h"

namespace hemirad {
namespace {

/// Bounds the time, a second or two; who is not looked at counts as seen.
constexpr std::size_t kMostLooks = 400'000'000;

/// Corners of a patch lie on a line that a ray just passes.
constexpr double kEdgeSlack = 1e-9;

struct Ray {
    glm::dvec3 from, along;  ///< unit
};

/// How far along the ray it meets the patch; infinity where it does not.
double distance_to(const Mesh& mesh, const Patch& patch, const glm::dvec3& normal, const Ray& ray) {
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    const double towards = glm::dot(normal, ray.along);
    if (std::abs(towards) < kEdgeSlack) return kNowhere;
    const double distance = glm::dot(normal, mesh.vertices[patch.corners[0]] - ray.from) / towards;
    const glm::dvec3 at = ray.from + distance * ray.along;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 &a = mesh.vertices[patch.corners[i]],
                         &b = mesh.vertices[patch.corners[(i + 1) % 4]];
        const glm::dvec3 edge = b - a;
        if (glm::dot(glm::cross(edge, at - a), normal) < -kEdgeSlack * glm::dot(edge, edge))
            return kNowhere;
    }
    return distance;
}

struct Hit {
    double distance;
    bool shows_front;
};

/// Whether the first thing that a patch has over it, not counting what lies on it, turns its back
/// on it. The sky does not.
bool looks_at_backs(const Mesh& mesh, std::uint32_t index) {
    const Patch& own = mesh.patches[index];
    const Ray ray{mesh.centroid(own), mesh.surfaces[own.surface].normal};
    const double least = std::max(4 * mesh.weld, 1e-9 * std::sqrt(mesh.area(own)));
    std::vector<Hit> hits;
    for (const Patch& patch : mesh.patches) {
        const Surface& surface = mesh.surfaces[patch.surface];
        const double distance = distance_to(mesh, patch, surface.normal, ray);
        if (distance > least && std::isfinite(distance))
            hits.push_back(
                {distance, surface.has_chart && glm::dot(surface.normal, ray.along) < 0});
    }
    if (hits.empty()) return false;
    const double nearest = std::ranges::min(hits, {}, &Hit::distance).distance;
    return std::ranges::none_of(
        hits, [&](const Hit& hit) { return hit.distance <= nearest + least && hit.shows_front; });
}

/// Patches of one side that share edges, by their number in the surface.
std::map<std::uint32_t, std::vector<std::uint32_t>> regions_of(const Mesh& mesh,
                                                               const Surface& surface) {
    meshing::DisjointSets regions(surface.patch_count);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_at;
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const auto& corners = mesh.patches[surface.first_patch + i].corners;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t a = corners[k], b = corners[(k + 1) % 4];
            if (a == b) continue;
            const auto [other, is_new] = first_at.try_emplace(std::minmax(a, b), i);
            if (!is_new && surface.side(other->second) == surface.side(i))
                regions.join(other->second, i);
        }
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) members[regions.find(i)].push_back(i);
    return members;
}

class HiddenFinder {
  public:
    explicit HiddenFinder(const Mesh& mesh) : mesh_(mesh), hidden_(mesh.patches.size(), false) {}

    std::vector<bool> run() {
        for (const Surface& surface : mesh_.surfaces)
            if (surface.has_chart && surface.side_count() > 1) look_at(surface);
        return std::move(hidden_);
    }

  private:
    void look_at(const Surface& surface) {
        for (const auto& [root, members] : regions_of(mesh_, surface)) {
            const std::uint32_t largest =
                *std::ranges::max_element(members, {}, [&](std::uint32_t i) {
                    return mesh_.area(mesh_.patches[surface.first_patch + i]);
                });
            looks_ += mesh_.patches.size();
            if (looks_ > kMostLooks) return;
            if (!looks_at_backs(mesh_, surface.first_patch + largest)) continue;
            for (const std::uint32_t i : members) hidden_[surface.first_patch + i] = true;
        }
    }

    const Mesh& mesh_;
    std::vector<bool> hidden_;
    std::size_t looks_ = 0;
};

}  // namespace

std::vector<bool> find_hidden(const Mesh& mesh) { return HiddenFinder(mesh).run(); }

}  // namespace hemirad
