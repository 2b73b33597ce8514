#include "scene/move_onto_edges.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>

#include "scene/edges.h"
#include "scene/flat_faces.h"
#include "scene/point_tree.h"

namespace hemirad::meshing {
namespace {

/// In precisions: a vertex onto its edge, and with that, if its ends move as well.
constexpr double kFarthest = 2;

std::vector<Edge> open_edges(const Outlines& outlines) {
    std::vector<Edge> edges, open;
    edges.reserve(outlines.corners.size());
    for (std::uint32_t face = 0; face < outlines.face_count(); ++face) {
        const auto outline = outlines[face];
        for (std::size_t i = 0; i < outline.size(); ++i)
            edges.emplace_back(outline[i], outline[(i + 1) % outline.size()], face);
    }
    sort_edges(edges);
    for_each_shared(edges, [&](std::span<const Edge> shared) {
        const auto up = std::ranges::count_if(shared, &Edge::ascending);
        if (2 * up != std::ssize(shared)) open.insert(open.end(), shared.begin(), shared.end());
    });
    return open;
}

std::vector<std::uint32_t> ends_of(const std::vector<Edge>& edges) {
    std::vector<std::uint32_t> ends;
    for (const Edge& edge : edges) ends.insert(ends.end(), {edge.low(), edge.high()});
    std::ranges::sort(ends);
    const auto repeated = std::ranges::unique(ends);
    ends.erase(repeated.begin(), repeated.end());
    return ends;
}

/// A vertex and the edge that it lies on.
struct Junction {
    std::uint32_t vertex, low, high;
    double length;  ///< of the edge
    glm::dvec3 from;
};

/// Ordered by vertex.
std::vector<Junction> find_junctions(const std::vector<Edge>& edges, const VertexWelder& vertices,
                                     double precision) {
    const PointTree tree(vertices.positions(), ends_of(edges));
    std::map<std::uint32_t, Junction> longest;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (e > 0 && edges[e].key == edges[e - 1].key) continue;
        const std::uint32_t low = edges[e].low(), high = edges[e].high();
        const double length = glm::distance(vertices[low], vertices[high]);
        for (const std::uint32_t v : tree.near(vertices[low], vertices[high], precision)) {
            if (v == low || v == high) continue;
            const auto [entry, is_new] = longest.try_emplace(v, Junction{v, low, high, length, {}});
            if (!is_new && length > entry->second.length)
                entry->second = {v, low, high, length, {}};
        }
    }
    std::vector<Junction> junctions;
    for (auto& [vertex, junction] : longest) {
        junction.from = vertices[vertex];
        junctions.push_back(junction);
    }
    return junctions;
}

glm::dvec3 nearest_on(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& p) {
    const glm::dvec3 along = b - a;
    return a + along * (glm::dot(p - a, along) / glm::dot(along, along));
}

double largest_axis(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The faces about vertices.
class Surroundings {
  public:
    Surroundings(const Outlines& outlines, std::size_t vertex_count)
        : outlines_(outlines), first_(vertex_count + 1, 0), faces_(outlines.corners.size()) {
        for (const std::uint32_t v : outlines.corners) ++first_[v + 1];
        for (std::size_t v = 0; v < vertex_count; ++v) first_[v + 1] += first_[v];
        auto next = first_;
        for (std::uint32_t face = 0; face < outlines.face_count(); ++face)
            for (const std::uint32_t v : outlines[face]) faces_[next[v]++] = face;
    }

    // A corner that moves by d changes the area vector by half of d times the diagonal between its
    // neighbours. Where each of a face's n corners changes it by no more than 1 / 2n, half of the
    // face stands whatever else moves.
    bool stand(std::uint32_t vertex, double distance, const VertexWelder& vertices) const {
        for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
            const auto outline = outlines_[faces_[i]];
            const auto n = outline.size();
            const double area = glm::length(area_vector(outline, vertices.positions()));
            for (std::size_t c = 0; c < n; ++c) {
                const double diagonal = glm::distance(vertices[outline[(c + 1) % n]],
                                                      vertices[outline[(c + n - 1) % n]]);
                const bool moves = outline[c] == vertex;
                if (moves && double(n) * distance * diagonal > area) return false;
            }
        }
        return true;
    }

  private:
    const Outlines& outlines_;
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> faces_;
};

// Ends of edges may lie on others, in rings even (tiles laid as a pinwheel): sweeps, until nothing
// moves by more than doubles round. Each takes errors down by the part of its edge at which a
// vertex lies, times the sine between the edges.
void settle(const std::vector<Junction>& junctions, double precision, VertexWelder& vertices) {
    constexpr int kMostSweeps = 100;
    bool moves = true;
    for (int sweep = 0; moves && sweep < kMostSweeps; ++sweep) {
        moves = false;
        for (const Junction& junction : junctions) {
            const glm::dvec3 &a = vertices[junction.low], &b = vertices[junction.high];
            const glm::dvec3 at = vertices[junction.vertex];
            const glm::dvec3 to = nearest_on(a, b, at);
            const double rounding =
                0x1p-51 * std::max({largest_axis(a), largest_axis(b), largest_axis(at)});
            if (largest_axis(to - at) <= rounding) continue;
            if (glm::distance(to, junction.from) > kFarthest * precision) continue;
            vertices.move(junction.vertex, to);
            moves = true;
        }
    }
}

}  // namespace

std::uint32_t move_onto_edges(const Outlines& outlines, const Precision& precision,
                              VertexWelder& vertices) {
    auto junctions = find_junctions(open_edges(outlines), vertices, precision.plane);
    if (junctions.empty()) return 0;
    const Surroundings faces(outlines, vertices.positions().size());
    std::erase_if(junctions, [&](const Junction& j) {
        return !faces.stand(j.vertex, kFarthest * precision.plane, vertices);
    });
    settle(junctions, precision.plane, vertices);
    return static_cast<std::uint32_t>(std::ranges::count_if(
        junctions, [&](const Junction& j) { return vertices[j.vertex] != j.from; }));
}

}  // namespace hemirad::meshing
