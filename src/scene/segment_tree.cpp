#include "scene/segment_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

namespace hemirad::meshing {
namespace {

constexpr std::uint32_t kLeaf = 8;

/// Whether the interval [low, high] along the axis and the box's shadow there meet.
bool overlaps(const glm::dvec3& middle, const glm::dvec3& half, const glm::dvec3& axis, double low,
              double high) {
    const double at = glm::dot(middle, axis), reach = glm::dot(half, glm::abs(axis));
    return at - reach <= high && at + reach >= low;
}

int longest_axis(const glm::dvec3& side) {
    return side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
}

}  // namespace

void SegmentTree::Box::add(const glm::dvec3& position) {
    low = glm::min(low, position);
    high = glm::max(high, position);
}

SegmentTree::SegmentTree(const std::vector<glm::dvec3>& positions, std::vector<Segment> segments)
    : positions_(positions), segments_(std::move(segments)), order_(segments_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

glm::dvec3 SegmentTree::doubled_middle(std::uint32_t segment) const {
    return positions_[segments_[segment][0]] + positions_[segments_[segment][1]];
}

SegmentTree::Box SegmentTree::box_of(std::uint32_t begin, std::uint32_t end) const {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i)
        for (const std::uint32_t v : segments_[order_[i]]) box.add(positions_[v]);
    return box;
}

std::array<SegmentTree::Box, 2> SegmentTree::ends_along(int axis, std::uint32_t begin,
                                                        std::uint32_t end) const {
    std::array<Box, 2> ends;
    for (std::uint32_t i = begin; i < end; ++i) {
        const auto& [a, b] = segments_[order_[i]];
        const bool ascends = positions_[a][axis] <= positions_[b][axis];
        ends[0].add(positions_[ascends ? a : b]);
        ends[1].add(positions_[ascends ? b : a]);
    }
    return ends;
}

void SegmentTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto node = nodes_.size();
    const Box box = box_of(begin, end);
    nodes_.push_back(
        {box, ends_along(longest_axis(box.high - box.low), begin, end), begin, end, 0});
    if (end - begin <= kLeaf) return;
    Box middles;
    for (std::uint32_t i = begin; i < end; ++i) middles.add(doubled_middle(order_[i]));
    const int axis = longest_axis(middles.high - middles.low);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return doubled_middle(a)[axis] < doubled_middle(b)[axis];
                     });
    build(begin, middle);
    nodes_[node].upper = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
}

bool SegmentTree::meets(const Slab& slab, const Box& box) {
    const Frame& frame = slab.frame;
    const glm::dvec3 middle = 0.5 * (box.low + box.high) - frame.origin;
    const glm::dvec3 half = 0.5 * (box.high - box.low) + slab.precision;
    return overlaps(middle, half, frame.normal, 0, 0) &&
           overlaps(middle, half, frame.u, 0, slab.size.x) &&
           overlaps(middle, half, frame.v, 0, slab.size.y);
}

// Twice the precision, so that rounding loses none.
bool SegmentTree::meets_plane(const Slab& slab, const Box& box) {
    const glm::dvec3 middle = 0.5 * (box.low + box.high) - slab.frame.origin;
    const glm::dvec3 half = 0.5 * (box.high - box.low) + 2 * slab.precision;
    return overlaps(middle, half, slab.frame.normal, 0, 0);
}

bool SegmentTree::lies_in_plane(const Slab& slab, std::uint32_t segment) const {
    return std::ranges::all_of(segments_[segment], [&](std::uint32_t v) {
        const double height = glm::dot(positions_[v] - slab.frame.origin, slab.frame.normal);
        return std::abs(height) <= slab.precision;
    });
}

std::vector<std::uint32_t> SegmentTree::in(const Slab& slab, std::size_t* looks) const {
    std::vector<std::uint32_t> found, open;
    if (!nodes_.empty()) open.push_back(0);
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        const Node& node = nodes_[index];
        open.pop_back();
        if (looks) ++*looks;
        if (!meets_plane(slab, node.ends[0]) || !meets_plane(slab, node.ends[1]) ||
            !meets(slab, node.box))
            continue;
        if (node.upper != 0) {
            open.insert(open.end(), {node.upper, index + 1});
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (lies_in_plane(slab, order_[i]) && meets(slab, box_of(i, i + 1)))
                found.push_back(order_[i]);
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace hemirad::meshing
