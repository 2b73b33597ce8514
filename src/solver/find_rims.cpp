#include "solver/find_rims.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <tuple>
#include <unordered_map>

namespace hemirad {
namespace {

struct Edge {
    std::uint32_t low, high;  ///< vertices
    std::uint64_t sheet;
    std::uint32_t patch;
    std::uint8_t bit;
    bool ascends;
};

/// [surface] Alike where one goes on in the other: in the same plane, with fronts to the same side.
std::vector<std::uint64_t> sheets_of(const Mesh& mesh) {
    std::vector<std::uint64_t> sheets;
    std::unordered_map<std::uint32_t, glm::dvec3> fronts;  // by plane, of its first surface
    for (const Surface& surface : mesh.surfaces) {
        if (surface.plane == kOwnPlane) {
            sheets.push_back(2 * std::uint64_t{kOwnPlane} + sheets.size());
            continue;
        }
        const auto& front = fronts.emplace(surface.plane, surface.normal).first->second;
        const bool faces_back = glm::dot(surface.normal, front) < 0;
        sheets.push_back(2 * std::uint64_t{surface.plane} + std::uint64_t{faces_back});
    }
    return sheets;
}

auto place_of(const Edge& edge) { return std::tuple(edge.low, edge.high, edge.sheet); }

std::vector<Edge> edges_of(const Mesh& mesh, std::uint32_t corner_count) {
    const auto sheets = sheets_of(mesh);
    std::vector<Edge> edges;
    edges.reserve(std::size_t{corner_count} * mesh.patches.size());
    for (std::uint32_t patch = 0; patch < mesh.patches.size(); ++patch)
        for (std::uint32_t k = 0; k < corner_count; ++k) {
            const auto& corners = mesh.patches[patch].corners;
            const std::uint32_t from = corners[k], to = corners[(k + 1) % corner_count];
            if (from != to)
                edges.push_back({std::min(from, to), std::max(from, to),
                                 sheets[mesh.patches[patch].surface], patch,
                                 static_cast<std::uint8_t>(1u << k), from < to});
        }
    std::ranges::sort(edges, {}, place_of);
    return edges;
}

}  // namespace

std::vector<std::uint8_t> find_rims(const Mesh& mesh, std::uint32_t corner_count) {
    std::vector<std::uint8_t> rims(mesh.patches.size(), 0);
    const auto edges = edges_of(mesh, corner_count);
    for (auto first = edges.begin(); first != edges.end();) {
        const auto last = std::find_if(first, edges.end(), [&](const Edge& edge) {
            return place_of(edge) != place_of(*first);
        });
        const auto ascending = std::count_if(first, last, std::mem_fn(&Edge::ascends));
        if (ascending == 0 || ascending == last - first)
            for (auto edge = first; edge != last; ++edge) rims[edge->patch] |= edge->bit;
        first = last;
    }
    return rims;
}

}  // namespace hemirad
