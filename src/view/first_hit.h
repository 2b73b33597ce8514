#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "scene/bounds.h"
#include "scene/scene.h"

namespace hemirad {

/// The first front of a scene of triangles along a ray, in double precision: boxes in a binary
/// tree, halved at the median. No ray passes between two triangles that share an edge.
class FirstHit {
  public:
    struct Hit {
        std::uint32_t face;
        glm::dvec3 weights;  ///< of its corners
        double distance;     ///< in lengths of the direction
    };

    /// The scene must outlive it.
    explicit FirstHit(const Scene& scene);

    std::optional<Hit> operator()(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    struct Node {
        Bounds box;
        std::uint32_t first, count;  ///< of order_; a leaf where count > 0
        std::uint32_t second_child;  ///< the first child follows its parent
    };

    void build(std::uint32_t first, std::uint32_t count);
    Bounds box_of(std::uint32_t face) const;
    void meet(std::uint32_t face, const glm::dvec3& origin, const glm::dvec3& direction,
              std::optional<Hit>& nearest) const;

    const Scene& scene_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace hemirad
