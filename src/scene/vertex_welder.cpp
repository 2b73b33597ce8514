#include "scene/vertex_welder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace hemirad::meshing {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// Wide enough that the box of one tolerance around a vertex rarely touches a second cell, narrow
// enough that only vertices which nearly touch share one.
constexpr double kCellInTolerances = 16;

}  // namespace

VertexWelder::VertexWelder(double tolerance, std::size_t expected)
    : tolerance_(tolerance), cell_size_(tolerance > 0 ? kCellInTolerances * tolerance : 1.0) {
    positions_.reserve(expected);
    next_.reserve(expected);
    heads_.assign(std::bit_ceil(std::max<std::size_t>(expected, 16)), kNone);
}

std::uint32_t VertexWelder::add(const glm::dvec3& position) { return add(position, tolerance_); }

// Lines that cross at the flattest that PolygonSplitter's callers let them, 2^-12 rad, take a few
// roundings of 2^-53 to a few of 2^-41.
std::uint32_t VertexWelder::add_apart(const glm::dvec3& position) {
    const double largest =
        std::max({std::abs(position.x), std::abs(position.y), std::abs(position.z)});
    return add(position, std::min(tolerance_, 0x1p-38 * largest));
}

std::uint32_t VertexWelder::add(const glm::dvec3& position, double tolerance) {
    if (const std::uint32_t found = find(position, tolerance); found != kNone) return found;
    const auto vertex = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(position);
    next_.push_back(kNone);
    if (positions_.size() > heads_.size())
        grow();
    else
        link(vertex);
    return vertex;
}

void VertexWelder::move(std::uint32_t vertex, const glm::dvec3& to) {
    unlink(vertex);
    positions_[vertex] = to;
    link(vertex);
}

VertexWelder::Cell VertexWelder::cell_of(const glm::dvec3& position) const {
    return {static_cast<std::int64_t>(std::floor(position.x / cell_size_)),
            static_cast<std::int64_t>(std::floor(position.y / cell_size_)),
            static_cast<std::int64_t>(std::floor(position.z / cell_size_))};
}

// Multiplicative hashing with the odd integer nearest 2^64 / golden ratio (Knuth vol. 3, 6.4).
std::uint32_t VertexWelder::bucket_of(const Cell& cell) const {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(index)) * kGolden;
        hash ^= hash >> 32;
    }
    return static_cast<std::uint32_t>(hash & (heads_.size() - 1));
}

// Buckets keep no cell: a stranger in the same bucket is too far away to be taken.
std::uint32_t VertexWelder::find_in(const Cell& cell, const glm::dvec3& position,
                                    double tolerance) const {
    std::uint32_t first = kNone;
    for (std::uint32_t v = heads_[bucket_of(cell)]; v != kNone; v = next_[v]) {
        const glm::dvec3 apart = positions_[v] - position;
        if (glm::dot(apart, apart) <= tolerance * tolerance) first = std::min(first, v);
    }
    return first;
}

// The lowest index in reach, so that the answer does not depend on the order within a bucket.
std::uint32_t VertexWelder::find(const glm::dvec3& position, double tolerance) const {
    const Cell low = cell_of(position - tolerance);
    const Cell high = cell_of(position + tolerance);
    if (low == high) return find_in(low, position, tolerance);
    std::uint32_t first = kNone;
    for (int corner = 0; corner < 8; ++corner) {
        const Cell cell = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                           corner & 4 ? high[2] : low[2]};
        first = std::min(first, find_in(cell, position, tolerance));
    }
    return first;
}

void VertexWelder::link(std::uint32_t vertex) {
    std::uint32_t& head = heads_[bucket_of(cell_of(positions_[vertex]))];
    next_[vertex] = head;
    head = vertex;
}

void VertexWelder::unlink(std::uint32_t vertex) {
    std::uint32_t* link = &heads_[bucket_of(cell_of(positions_[vertex]))];
    while (*link != vertex) link = &next_[*link];
    *link = next_[vertex];
}

void VertexWelder::grow() {
    heads_.assign(2 * heads_.size(), kNone);
    for (std::uint32_t v = 0; v < positions_.size(); ++v) link(v);
}

}  // namespace hemirad::meshing
