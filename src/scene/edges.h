#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/flat_faces.h"

namespace hemirad::meshing {

/// A directed edge of an outline. `owner` is the flat, or whatever else has outlines.
struct Edge {
    std::uint64_t key;  ///< lower vertex in the high half, higher vertex in the low half
    std::uint32_t owner;
    bool ascending;  ///< runs from the lower vertex to the higher one

    Edge(std::uint32_t from, std::uint32_t to, std::uint32_t of)
        : key(std::uint64_t{std::min(from, to)} << 32 | std::max(from, to)),
          owner(of),
          ascending(from < to) {}
    std::uint32_t low() const { return static_cast<std::uint32_t>(key >> 32); }
    std::uint32_t high() const { return static_cast<std::uint32_t>(key); }
    std::uint32_t from() const { return ascending ? low() : high(); }
    std::uint32_t to() const { return ascending ? high() : low(); }
};

inline void sort_edges(std::vector<Edge>& edges) {
    std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
        return a.key != b.key ? a.key < b.key : a.owner < b.owner;
    });
}

/// Calls visit(span of edges between the same two vertices) for each such pair.
template <class Visit>
void for_each_shared(std::span<const Edge> sorted, Visit visit) {
    for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
        while (end < sorted.size() && sorted[end].key == sorted[begin].key) ++end;
        visit(sorted.subspan(begin, end - begin));
    }
}

/// The outlines of all flats, sorted.
std::vector<Edge> edges_of(const FlatFaces& faces);

}  // namespace hemirad::meshing
