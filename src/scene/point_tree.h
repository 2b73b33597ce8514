#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace hemirad::meshing {

/// A k-d tree (Bentley 1975) that finds points near a segment.
class PointTree {
  public:
    PointTree(const std::vector<glm::dvec3>& positions, std::vector<std::uint32_t> points);

    /// The points within `distance` of the segment's interior: those whose nearest place on its
    /// line is neither end. In no particular order.
    std::vector<std::uint32_t> near(const glm::dvec3& from, const glm::dvec3& to,
                                    double distance) const;

  private:
    void build(std::size_t begin, std::size_t end);

    const std::vector<glm::dvec3>& positions_;
    std::vector<std::uint32_t> points_;
    std::vector<std::uint8_t> axes_;  ///< of the split at a range's middle
};

}  // namespace hemirad::meshing
