#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "scene/frame.h"

namespace hemirad::meshing {

/// Between two vertices.
using Segment = std::array<std::uint32_t, 2>;

/// A rectangle from its frame's origin to `size`, and what is within `precision` of it.
struct Slab {
    Frame frame;
    glm::dvec2 size;
    double precision;
};

/// A tree of bounding boxes, halved at the median (Kay and Kajiya 1986), that finds segments in
/// the plane of a rectangle.
class SegmentTree {
  public:
    SegmentTree(const std::vector<glm::dvec3>& positions, std::vector<Segment> segments);

    /// Ascending; those whose ends lie within the precision of the slab's plane and whose own boxes
    /// meet the slab. Adds to `looks` the boxes that were looked at.
    std::vector<std::uint32_t> in(const Slab& slab, std::size_t* looks = nullptr) const;

  private:
    struct Box {
        glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;

        void add(const glm::dvec3& position);
    };
    struct Node {
        Box box;
        /// Of the lower and of the upper ends along the box's longest side: of a fan's edges the
        /// box holds the hub, which lies in all their planes, but few of the other ends do.
        std::array<Box, 2> ends;
        std::uint32_t begin, end;
        std::uint32_t upper;  ///< the other child follows its parent; 0: a leaf
    };

    void build(std::uint32_t begin, std::uint32_t end);
    Box box_of(std::uint32_t begin, std::uint32_t end) const;
    std::array<Box, 2> ends_along(int axis, std::uint32_t begin, std::uint32_t end) const;
    glm::dvec3 doubled_middle(std::uint32_t segment) const;
    static bool meets_plane(const Slab& slab, const Box& box);
    static bool meets(const Slab& slab, const Box& box);
    bool lies_in_plane(const Slab& slab, std::uint32_t segment) const;

    const std::vector<glm::dvec3>& positions_;
    std::vector<Segment> segments_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace hemirad::meshing
