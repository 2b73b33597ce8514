#include "solver/join_sides.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "scene/point_tree.h"
#include "scene/vertex_welder.h"

namespace hemirad {
namespace {

// Contacts lie on a surface to twice the weld, on either side.
constexpr double kMergedWelds = 2, kBesideWelds = 4;

/// Directions around an edge that differ by less may be in either order.
constexpr double kSameAngle = 1e-5;

/// A patch's, between two vertices.
struct PatchEdge {
    std::uint32_t low, high;
    std::uint32_t patch;
    bool ascends;  ///< the patch lies to the left of the way from low to high
};

/// Of an edge, between vertices on it.
struct EdgePart : PatchEdge {
    glm::dvec3 whole;  ///< all of the edge, in the direction from low to high
};

auto place_of(const PatchEdge& edge) { return std::pair(edge.low, edge.high); }

std::vector<PatchEdge> edges_of(const Mesh& mesh, const Surface& surface,
                                const MergedVertices& vertices) {
    std::vector<PatchEdge> edges;
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const std::uint32_t patch = surface.first_patch + i;
        const auto& corners = mesh.patches[patch].corners;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t from = vertices.of[corners[k]];
            const std::uint32_t to = vertices.of[corners[(k + 1) % 4]];
            if (from != to)
                edges.push_back({std::min(from, to), std::max(from, to), patch, from < to});
        }
    }
    return edges;
}

/// Calls visit(edges between the same two vertices) for all of them.
template <class Edge, class Visit>
void for_each_shared(std::vector<Edge>& edges, Visit visit) {
    std::ranges::sort(edges, {}, [](const PatchEdge& edge) {
        return std::tuple(edge.low, edge.high, edge.patch, edge.ascends);
    });
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && place_of(edges[end]) == place_of(edges[begin])) ++end;
        visit(std::span<const Edge>(&edges[begin], end - begin));
    }
}

class SideJoiner {
  public:
    SideJoiner(const Mesh& mesh, const MergedVertices& vertices)
        : mesh_(mesh), vertices_(vertices), sides_(2 * mesh.patches.size()) {
        find_normals();
    }

    meshing::DisjointSets run() {
        std::vector<PatchEdge> loose;
        for (const Surface& surface : mesh_.surfaces) join_within(surface, loose);
        std::vector<EdgePart> parts = cut_at_vertices(loose);
        for_each_shared(parts, [&](std::span<const EdgePart> shared) { join_around(shared); });
        return std::move(sides_);
    }

  private:
    /// A patch that meets an edge, seen along it.
    struct Leaf {
        double angle;
        std::uint32_t patch;
        bool faces_on;  ///< its front looks to where angles grow
    };

    // Surfaces of one plane have the same, up to the sign.
    void find_normals() {
        std::unordered_map<std::uint32_t, glm::dvec3> of_plane;
        for (const Surface& surface : mesh_.surfaces) {
            glm::dvec3 normal = surface.normal;
            if (surface.plane != kOwnPlane) {
                const glm::dvec3& first = of_plane.emplace(surface.plane, normal).first->second;
                normal = glm::dot(first, normal) < 0 ? -first : first;
            }
            normals_.push_back(normal);
        }
    }

    // Most edges lie inside of a surface on which nothing stands. The others are loose.
    void join_within(const Surface& surface, std::vector<PatchEdge>& loose) {
        auto edges = edges_of(mesh_, surface, vertices_);
        for_each_shared(edges, [&](std::span<const PatchEdge> shared) {
            if (surface.walls.empty() && shared.size() == 2 &&
                shared[0].ascends != shared[1].ascends) {
                sides_.join(front_of(shared[0].patch), front_of(shared[1].patch));
                sides_.join(back_of(shared[0].patch), back_of(shared[1].patch));
            } else {
                loose.insert(loose.end(), shared.begin(), shared.end());
            }
        });
    }

    // Between the vertices of others that lie on them.
    std::vector<EdgePart> cut_at_vertices(std::vector<PatchEdge>& edges) const {
        std::vector<std::uint32_t> ends;
        for (const PatchEdge& edge : edges) ends.insert(ends.end(), {edge.low, edge.high});
        std::ranges::sort(ends);
        ends.erase(std::ranges::unique(ends).begin(), ends.end());
        const meshing::PointTree tree(vertices_.positions, std::move(ends));
        std::vector<EdgePart> parts;
        for_each_shared(edges, [&](std::span<const PatchEdge> shared) {
            const auto stops = stops_on(shared.front(), tree);
            for (const PatchEdge& edge : shared)
                for (std::size_t i = 1; i < stops.size(); ++i)
                    parts.push_back(part_of(edge, stops[i - 1], stops[i]));
        });
        return parts;
    }

    std::vector<std::uint32_t> stops_on(const PatchEdge& edge,
                                        const meshing::PointTree& tree) const {
        const auto& at = vertices_.positions;
        auto stops = tree.near(at[edge.low], at[edge.high], kBesideWelds * mesh_.weld);
        std::erase_if(stops, [&](std::uint32_t v) { return v == edge.low || v == edge.high; });
        const glm::dvec3 along = at[edge.high] - at[edge.low];
        std::ranges::sort(stops, {}, [&](std::uint32_t v) {
            return std::pair(glm::dot(at[v] - at[edge.low], along), v);
        });
        stops.insert(stops.begin(), edge.low);
        stops.push_back(edge.high);
        return stops;
    }

    EdgePart part_of(const PatchEdge& edge, std::uint32_t from, std::uint32_t to) const {
        const glm::dvec3 whole = vertices_.positions[edge.high] - vertices_.positions[edge.low];
        if (from < to) return {{from, to, edge.patch, edge.ascends}, whole};
        return {{to, from, edge.patch, !edge.ascends}, -whole};
    }

    std::vector<Leaf> leaves_around(std::span<const EdgePart> shared) const {
        const glm::dvec3 axis =
            glm::normalize(std::ranges::max(shared, {}, [](const EdgePart& edge) {
                               return glm::dot(edge.whole, edge.whole);
                           }).whole);
        glm::dvec3 right{}, up{};
        std::vector<Leaf> leaves;
        for (const EdgePart& edge : shared) {
            const glm::dvec3 left = glm::cross(normals_[mesh_.patches[edge.patch].surface], axis);
            const glm::dvec3 inwards = edge.ascends ? left : -left;
            if (leaves.empty()) {
                right = glm::normalize(inwards);
                up = glm::cross(axis, right);
            }
            double angle = std::atan2(glm::dot(inwards, up), glm::dot(inwards, right));
            if (angle < -kSameAngle) angle += 2 * std::numbers::pi;
            leaves.push_back({angle, edge.patch, edge.ascends});
        }
        std::ranges::stable_sort(leaves, {}, &Leaf::angle);
        return leaves;
    }

    /// Leaves at one angle: what they look at this way and that.
    struct Fold {
        std::uint32_t below, above;
    };

    bool lie_in_one_plane(std::span<const Leaf> leaves) const {
        const std::uint32_t first = mesh_.patches[leaves[0].patch].surface;
        return std::ranges::all_of(leaves, [&](const Leaf& leaf) {
            const std::uint32_t own = mesh_.patches[leaf.patch].surface;
            return own == first || (mesh_.surfaces[own].plane != kOwnPlane &&
                                    mesh_.surfaces[own].plane == mesh_.surfaces[first].plane);
        });
    }

    // The two sides of a wall without thickness are such, and turn their backs on each other; so,
    // for want of anything that could be seen, do a block's underside and what it stands on.
    Fold fold(std::span<const Leaf> leaves) {
        const Leaf* on = nullptr;
        const Leaf* back = nullptr;
        for (const Leaf& leaf : leaves) {
            const Leaf*& first = leaf.faces_on ? on : back;
            if (first == nullptr) first = &leaf;
            sides_.join(front_of(leaf.patch), front_of(first->patch));
            sides_.join(back_of(leaf.patch), back_of(leaves[0].patch));
        }
        if (!lie_in_one_plane(leaves)) {
            for (const Leaf& leaf : leaves)
                sides_.join(front_of(leaf.patch), back_of(leaves[0].patch));
        }
        return {back != nullptr ? front_of(back->patch) : back_of(on->patch),
                on != nullptr ? front_of(on->patch) : back_of(back->patch)};
    }

    void join_around(std::span<const EdgePart> shared) {
        const auto leaves = leaves_around(shared);
        std::vector<Fold> folds;
        for (std::size_t begin = 0, end = 0; begin < leaves.size(); begin = end) {
            for (++end; end < leaves.size(); ++end)
                if (leaves[end].angle > leaves[end - 1].angle + kSameAngle) break;
            folds.push_back(fold(std::span(leaves).subspan(begin, end - begin)));
        }
        for (std::size_t i = 0; i < folds.size(); ++i)
            sides_.join(folds[i].above, folds[(i + 1) % folds.size()].below);
    }

    const Mesh& mesh_;
    const MergedVertices& vertices_;
    meshing::DisjointSets sides_;
    std::vector<glm::dvec3> normals_;  // [surface]
};

}  // namespace

MergedVertices merged_vertices(const Mesh& mesh) {
    meshing::VertexWelder welder(kMergedWelds * mesh.weld, mesh.vertices.size());
    MergedVertices result;
    result.of.reserve(mesh.vertices.size());
    for (const glm::dvec3& vertex : mesh.vertices) result.of.push_back(welder.add(vertex));
    result.positions = welder.positions();
    return result;
}

meshing::DisjointSets join_sides(const Mesh& mesh, const MergedVertices& vertices) {
    return SideJoiner(mesh, vertices).run();
}

}  // namespace hemirad
