#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/polygon.h"

namespace hemirad::meshing {

/// A tree of bounding boxes, halved at the median, over a polygon's corners, of which some count.
class ReflexTree {
  public:
    explicit ReflexTree(const Polygon& polygon);

    void set_reflex(std::uint32_t corner, bool reflex);

    /// A reflex corner in the counter-clockwise triangle, its border too, that is none of the
    /// triangle's vertices.
    std::optional<std::uint32_t> find_in(const std::array<Corner, 3>& triangle) const;

    std::size_t looks() const { return looks_; }  ///< at boxes and corners, so far

  private:
    struct Node {
        glm::dvec2 low, high;
        std::uint32_t begin, end;
        std::uint32_t upper;  ///< the other child follows its parent; 0: a leaf
        std::uint32_t reflex_count = 0;
    };

    void build(std::uint32_t begin, std::uint32_t end);
    static bool may_meet(const Node& node, const std::array<Corner, 3>& triangle);

    const Polygon& polygon_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;  ///< of each corner in the order
    std::vector<bool> is_reflex_;
    std::vector<Node> nodes_;
    mutable std::size_t looks_ = 0;
};

}  // namespace hemirad::meshing
