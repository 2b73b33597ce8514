#include "scene/reflex_tree.h"

#include <algorithm>
#include <glm/common.hpp>
#include <numeric>

namespace hemirad::meshing {
namespace {

constexpr std::uint32_t kLeaf = 8;

bool lies_in(const Corner& p, const std::array<Corner, 3>& triangle) {
    for (const auto& corner : triangle)
        if (corner.vertex == p.vertex) return false;
    return turn(triangle[0], triangle[1], p) >= 0 && turn(triangle[1], triangle[2], p) >= 0 &&
           turn(triangle[2], triangle[0], p) >= 0;
}

}  // namespace

ReflexTree::ReflexTree(const Polygon& polygon)
    : polygon_(polygon),
      order_(polygon.size()),
      place_(polygon.size()),
      is_reflex_(polygon.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
    for (std::uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
}

void ReflexTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = nodes_.size();
    Node node{polygon_[order_[begin]].at, polygon_[order_[begin]].at, begin, end, 0};
    for (std::uint32_t i = begin; i < end; ++i) {
        node.low = glm::min(node.low, polygon_[order_[i]].at);
        node.high = glm::max(node.high, polygon_[order_[i]].at);
    }
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return;
    const glm::dvec2 side = node.high - node.low;
    const int axis = side.x >= side.y ? 0 : 1;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         return polygon_[a].at[axis] < polygon_[b].at[axis];
                     });
    build(begin, middle);
    nodes_[index].upper = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
}

void ReflexTree::set_reflex(std::uint32_t corner, bool reflex) {
    if (is_reflex_[corner] == reflex) return;
    is_reflex_[corner] = reflex;
    for (std::uint32_t index = 0;;) {
        Node& node = nodes_[index];
        node.reflex_count += reflex ? 1 : -1;
        if (node.upper == 0) return;
        index = place_[corner] < nodes_[node.upper].begin ? index + 1 : node.upper;
    }
}

// turn() rounds monotonically in each coordinate, so at the box's corner furthest to the left of an
// edge it is at least what it is at any corner within.
bool ReflexTree::may_meet(const Node& node, const std::array<Corner, 3>& triangle) {
    for (int i = 0; i < 3; ++i) {
        const Corner &a = triangle[i], &b = triangle[(i + 1) % 3];
        const glm::dvec2 edge = b.at - a.at;
        const Corner leftmost{
            a.vertex,
            {edge.y > 0 ? node.low.x : node.high.x, edge.x > 0 ? node.high.y : node.low.y}};
        if (turn(a, b, leftmost) < 0) return false;
    }
    return true;
}

std::optional<std::uint32_t> ReflexTree::find_in(const std::array<Corner, 3>& triangle) const {
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const std::uint32_t index = open.back();
        const Node& node = nodes_[index];
        open.pop_back();
        ++looks_;
        if (node.reflex_count == 0 || !may_meet(node, triangle)) continue;
        if (node.upper != 0) {
            open.insert(open.end(), {node.upper, index + 1});
            continue;
        }
        looks_ += node.end - node.begin;
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (is_reflex_[order_[i]] && lies_in(polygon_[order_[i]], triangle)) return order_[i];
    }
    return {};
}

}  // namespace hemirad::meshing
