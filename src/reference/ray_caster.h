#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference/polygon.h"

namespace hemirad::reference {

/// First front along a ray, double precision: boxes in a binary tree, halved at the median.
class RayCaster {
  public:
    explicit RayCaster(std::span<const Polygon> polygons);

    /// Index of the nearest polygon that turns its front to the ray, or kEscaped.
    int operator()(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    struct Node {
        glm::dvec3 least, most;
        std::uint32_t first, count;  ///< of order_; a leaf where count > 0
        std::uint32_t second_child;  ///< the first child follows its parent
    };
    struct Hit;

    void build(std::uint32_t first, std::uint32_t count);
    void meet(int polygon, const glm::dvec3& origin, const glm::dvec3& direction, Hit& hit) const;

    std::vector<Polygon> polygons_;
    std::vector<glm::dvec3> normals_;
    std::vector<double> least_heights_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace hemirad::reference
