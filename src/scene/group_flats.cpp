#include "scene/group_flats.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace hemirad::meshing {
namespace {

using Vertices = std::vector<glm::dvec3>;

struct Neighbours {
    std::uint32_t a, b;
    auto operator<=>(const Neighbours&) const = default;
};

bool may_merge(const Scene& scene, const Flat& a, const Flat& b) {
    const Face& of_a = scene.faces[a.face];
    const Face& of_b = scene.faces[b.face];
    return of_a.object == of_b.object && of_a.material == of_b.material &&
           a.has_reverse == b.has_reverse;
}

/// The plane of a growing surface. The area vectors of neighbours add up to that of their common
/// outline, so its error shrinks as the surface grows, and a curve of tiny facets soon leaves it.
class GrowingPlane {
  public:
    void add(std::span<const std::uint32_t> outline, const Vertices& vertices) {
        const glm::dvec3 flat = area_vector(outline, vertices);
        const double weight = glm::length(flat);
        if (area_ == 0) base_ = vertices[outline[0]];
        glm::dvec3 mean(0);
        for (const std::uint32_t v : outline)
            mean += (vertices[v] - base_) / double(outline.size());
        area_ += weight;
        point_ += (mean - point_) * (weight / area_);
        direction_ += flat;
    }
    bool holds(std::span<const std::uint32_t> outline, const Vertices& vertices,
               double precision) const {
        if (glm::dot(direction_, area_vector(outline, vertices)) <= 0) return false;
        const glm::dvec3 normal = direction_ / glm::length(direction_);
        return std::ranges::all_of(outline, [&](std::uint32_t v) {
            return std::abs(glm::dot(normal, vertices[v] - base_ - point_)) <= precision;
        });
    }

  private:
    glm::dvec3 direction_{0}, base_{0};
    glm::dvec3 point_{0};  // from the base: far from the origin sums would lose digits
    double area_ = 0;
};

/// Which flats meet at an edge from opposite sides and may merge, as an adjacency list.
class Adjacency {
  public:
    Adjacency(const Scene& scene, const FlatFaces& faces, std::span<const Edge> edges) {
        for_each_shared(edges, [&](std::span<const Edge> shared) { link(scene, faces, shared); });
        std::ranges::sort(pairs_);
        first_.assign(faces.flats.size() + 1, 0);
        for (const auto& pair : pairs_) ++first_[pair.a + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
    }
    std::span<const Neighbours> of(std::uint32_t flat) const {
        return {pairs_.data() + first_[flat], pairs_.data() + first_[flat + 1]};
    }

  private:
    void link(const Scene& scene, const FlatFaces& faces, std::span<const Edge> shared) {
        constexpr std::size_t kMostAtAnEdge = 16;  // bounds the pairs; real junctions have four
        if (shared.size() > kMostAtAnEdge) return;
        for (const Edge& a : shared)
            for (const Edge& b : shared)
                if (a.ascending != b.ascending &&
                    may_merge(scene, faces.flats[a.owner], faces.flats[b.owner]))
                    pairs_.push_back({a.owner, b.owner});
    }

    std::vector<Neighbours> pairs_;
    std::vector<std::size_t> first_;
};

// The largest first: it knows its plane best.
std::vector<std::uint32_t> by_area(const FlatFaces& faces, const Vertices& vertices) {
    std::vector<double> areas;
    areas.reserve(faces.flats.size());
    for (const Flat& flat : faces.flats)
        areas.push_back(glm::length(area_vector(faces.outline(flat), vertices)));
    std::vector<std::uint32_t> order(areas.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::greater{},
                             [&](std::uint32_t flat) { return areas[flat]; });
    return order;
}

Group grow(std::uint32_t seed, const FlatFaces& faces, const Adjacency& adjacency,
           const Vertices& vertices, double precision, std::vector<bool>& taken) {
    Group group{seed};
    GrowingPlane plane;
    plane.add(faces.outline(faces.flats[seed]), vertices);
    taken[seed] = true;
    for (std::size_t next = 0; next < group.size(); ++next) {
        for (const auto& [flat, neighbour] : adjacency.of(group[next])) {
            const auto outline = faces.outline(faces.flats[neighbour]);
            if (taken[neighbour] || !plane.holds(outline, vertices, precision)) continue;
            taken[neighbour] = true;
            plane.add(outline, vertices);
            group.push_back(neighbour);
        }
    }
    std::ranges::sort(group);
    return group;
}

}  // namespace

std::vector<Group> group_coplanar(const Scene& scene, const FlatFaces& faces,
                                  std::span<const Edge> edges, const Vertices& vertices,
                                  const Precision& precision) {
    const Adjacency adjacency(scene, faces, edges);
    std::vector<bool> taken(faces.flats.size(), false);
    std::vector<Group> groups;
    for (const std::uint32_t seed : by_area(faces, vertices))
        if (!taken[seed])
            groups.push_back(grow(seed, faces, adjacency, vertices, precision.plane, taken));
    std::ranges::sort(groups, {}, [](const Group& group) { return group.front(); });
    return groups;
}

std::vector<Group> group_singly(const FlatFaces& faces) {
    std::vector<Group> groups;
    groups.reserve(faces.flats.size());
    for (std::uint32_t flat = 0; flat < faces.flats.size(); ++flat) groups.push_back({flat});
    return groups;
}

}  // namespace hemirad::meshing
