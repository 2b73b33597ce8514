#include "lightmap/find_hidden.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>

#include "scene/bounds.h"
#include "scene/disjoint_sets.h"

namespace hemirad {
namespace {

/// Bounds the time, a second or two; who is not looked at counts as seen.
constexpr std::size_t kMostLooks = 400'000'000;

/// Corners of a patch lie on a line that a ray just passes.
constexpr double kEdgeSlack = 1e-9;

/// Of the largest coordinate: more than kEdgeSlack and rounding.
constexpr double kRunSlack = 1e-8;

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

/// Patches that follow each other in the mesh, and where a ray may meet them.
struct Run {
    std::size_t first, end;
    Bounds bounds;
};

/// In the plane in which distance_to() looks for it.
void take_in(Bounds& bounds, const Mesh& mesh, const Patch& patch) {
    const glm::dvec3& normal = mesh.surfaces[patch.surface].normal;
    for (const std::uint32_t corner : patch.corners) {
        const glm::dvec3& at = mesh.vertices[corner];
        bounds.take_in(at + glm::dot(normal, mesh.vertices[patch.corners[0]] - at) * normal);
    }
}

std::vector<Run> runs_of(const Mesh& mesh) {
    constexpr std::size_t kPatches = 64;
    std::vector<Run> runs;
    Bounds all;
    for (std::size_t first = 0; first < mesh.patches.size(); first += kPatches) {
        Run run{first, std::min(first + kPatches, mesh.patches.size()), {}};
        for (std::size_t i = run.first; i < run.end; ++i)
            take_in(run.bounds, mesh, mesh.patches[i]);
        all.take_in(run.bounds);
        runs.push_back(run);
    }
    const glm::dvec3 reach = glm::max(glm::abs(all.least), glm::abs(all.most));
    const double slack = kRunSlack * std::max({reach.x, reach.y, reach.z});
    for (Run& run : runs) {
        run.bounds.least -= slack;
        run.bounds.most += slack;
    }
    return runs;
}

/// Slabs (Kay and Kajiya 1986).
bool meets(const Ray& ray, const Bounds& bounds) {
    const glm::dvec3 a = (bounds.least - ray.from) / ray.along;
    const glm::dvec3 b = (bounds.most - ray.from) / ray.along;
    const glm::dvec3 enter = glm::min(a, b), leave = glm::max(a, b);
    return std::max({enter.x, enter.y, enter.z, 0.0}) <= std::min({leave.x, leave.y, leave.z});
}

struct Hit {
    double distance;
    std::uint32_t surface;
};

/// A point of the patch that is on no line of a grid, nor below or above one.
glm::dvec3 inner_point(const Mesh& mesh, const Patch& patch) {
    constexpr std::array<double, 4> kWeights = {0.2871, 0.2393, 0.2637, 0.2099};
    glm::dvec3 point{};
    for (std::size_t i = 0; i < 4; ++i) point += kWeights[i] * mesh.vertices[patch.corners[i]];
    return point;
}

/// What a ray from a patch meets, in this order, not counting what lies on the patch.
class Sight {
  public:
    Sight(const Mesh& mesh, std::span<const Run> runs, std::uint32_t index, const glm::dvec3& along)
        : mesh_(mesh),
          ray_{inner_point(mesh, mesh.patches[index]), along},
          least_(std::max(4 * mesh.weld, 1e-9 * std::sqrt(mesh.area(mesh.patches[index])))) {
        for (const Run& run : runs)
            if (meets(ray_, run.bounds)) look_at(run);
        std::ranges::sort(hits_, {}, &Hit::distance);
        const auto repeated = std::ranges::unique(hits_, {}, &Hit::surface);
        hits_.erase(repeated.begin(), repeated.end());
    }

    /// The first thing turns its back. The sky does not.
    bool is_of_backs() const {
        return !hits_.empty() && std::ranges::none_of(hits_, [&](const Hit& hit) {
            return hit.distance <= hits_.front().distance + least_ &&
                   mesh_.surfaces[hit.surface].has_chart && shows_front(hit);
        });
    }

    /// In how many solids it begins: so many more are left than entered, but for the walls of the
    /// room that it may end at. Nothing where these cannot be told from what is left there.
    std::optional<int> solids() const {
        int left = 0;
        bool ends_at_front = false, ends_at_back = false;
        for (const Hit& hit : hits_) {
            if (!is_of_a_solid(hit)) continue;
            left += shows_front(hit) ? -1 : 1;
            if (hit.distance >= hits_.back().distance - least_)
                (shows_front(hit) ? ends_at_front : ends_at_back) = true;
        }
        if (ends_at_front && ends_at_back && left == 0) return {};
        return left + ends_at_front;
    }

  private:
    void look_at(const Run& run) {
        for (std::size_t i = run.first; i < run.end; ++i) {
            const Patch& patch = mesh_.patches[i];
            const double distance =
                distance_to(mesh_, patch, mesh_.surfaces[patch.surface].normal, ray_);
            if (distance > least_ && std::isfinite(distance))
                hits_.push_back({distance, patch.surface});
        }
    }
    bool shows_front(const Hit& hit) const {
        return glm::dot(mesh_.surfaces[hit.surface].normal, ray_.along) < 0;
    }
    bool is_of_a_solid(const Hit& hit) const {
        const Surface& surface = mesh_.surfaces[hit.surface];
        return !surface.is_back && surface.reverse == kNoReverse;
    }

    const Mesh& mesh_;
    Ray ray_;
    double least_;
    std::vector<Hit> hits_;
};

/// Whatever else stands on that solid, or reaches into it.
bool lies_in_a_solid(const Mesh& mesh, std::span<const Run> runs, std::uint32_t index) {
    // Along no axis, and ever steeper: what stands against a wall leaves the solid where the room
    // ends.
    constexpr std::array<glm::dvec2, 3> kSlopes = {{{2.31, 1.37}, {-1.73, 0.91}, {0.37, -0.53}}};
    const Surface& surface = mesh.surfaces[mesh.patches[index].surface];
    for (const glm::dvec2& slope : kSlopes) {
        const auto along = surface.normal + slope.x * surface.u_axis + slope.y * surface.v_axis;
        if (const auto solids = Sight(mesh, runs, index, glm::normalize(along)).solids())
            return *solids > 0;
    }
    return false;
}

bool is_covered(const Mesh& mesh, std::span<const Run> runs, std::uint32_t index) {
    const glm::dvec3& up = mesh.surfaces[mesh.patches[index].surface].normal;
    return Sight(mesh, runs, index, up).is_of_backs() || lies_in_a_solid(mesh, runs, index);
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
            if (surface.has_chart && surface.side_count() > 1) {
                if (runs_.empty()) runs_ = runs_of(mesh_);
                look_at(surface);
            }
        return std::move(hidden_);
    }

  private:
    void look_at(const Surface& surface) {
        for (const auto& [root, members] : regions_of(mesh_, surface)) {
            const std::uint32_t largest =
                *std::ranges::max_element(members, {}, [&](std::uint32_t i) {
                    return mesh_.area(mesh_.patches[surface.first_patch + i]);
                });
            looks_ += 2 * mesh_.patches.size();
            if (looks_ > kMostLooks) return;
            if (!is_covered(mesh_, runs_, surface.first_patch + largest)) continue;
            for (const std::uint32_t i : members) hidden_[surface.first_patch + i] = true;
        }
    }

    const Mesh& mesh_;
    std::vector<Run> runs_;
    std::vector<bool> hidden_;
    std::size_t looks_ = 0;
};

}  // namespace

std::vector<bool> find_hidden(const Mesh& mesh) { return HiddenFinder(mesh).run(); }

}  // namespace hemirad
