#include "solver/find_rims.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

namespace hemirad {
namespace {

struct Edge {
    std::uint32_t low, high;  ///< vertices
    std::uint32_t patch;
    std::uint8_t bit;
    bool ascends;
};

bool goes_on(const Mesh& mesh, const Edge& edge, const Edge& other) {
    const std::uint32_t a = mesh.patches[edge.patch].surface, b = mesh.patches[other.patch].surface;
    if (edge.ascends == other.ascends) return false;
    if (a == b) return true;
    const Surface &from = mesh.surfaces[a], &to = mesh.surfaces[b];
    return from.plane != kOwnPlane && from.plane == to.plane &&
           glm::dot(from.normal, to.normal) > 0;
}

std::vector<Edge> edges_of(const Mesh& mesh, std::uint32_t corner_count) {
    std::vector<Edge> edges;
    edges.reserve(std::size_t{corner_count} * mesh.patches.size());
    for (std::uint32_t patch = 0; patch < mesh.patches.size(); ++patch)
        for (std::uint32_t k = 0; k < corner_count; ++k) {
            const auto& corners = mesh.patches[patch].corners;
            const std::uint32_t from = corners[k], to = corners[(k + 1) % corner_count];
            if (from != to)
                edges.push_back({std::min(from, to), std::max(from, to), patch,
                                 static_cast<std::uint8_t>(1u << k), from < to});
        }
    std::ranges::sort(edges, {},
                      [](const Edge& edge) { return std::tuple(edge.low, edge.high, edge.patch); });
    return edges;
}

}  // namespace

std::vector<std::uint8_t> find_rims(const Mesh& mesh, std::uint32_t corner_count) {
    std::vector<std::uint8_t> rims(mesh.patches.size(), 0);
    const auto edges = edges_of(mesh, corner_count);
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const Edge& edge) {
            return edge.low != first->low || edge.high != first->high;
        });
        for (auto edge = first; edge != last; ++edge)
            if (std::none_of(first, last,
                             [&](const Edge& other) { return goes_on(mesh, *edge, other); }))
                rims[edge->patch] |= edge->bit;
        first = last;
    }
    return rims;
}

}  // namespace hemirad
