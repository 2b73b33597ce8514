#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/bounds.h"
#include "solver/join_sides.h"

namespace hemirad {

/// A closed surface of sides of patches, of which one can ask what lies within: a ray in a
/// direction that no scene is aligned with leaves it once more than it enters it.
class Enclosure {
  public:
    Enclosure(const Mesh& mesh, const MergedVertices& vertices,
              std::span<const std::uint32_t> sides);

    bool holds(const glm::dvec3& point) const;
    std::size_t looks() const { return looks_; }  ///< patches looked at so far

  private:
    /// A patch seen along the ray.
    struct Outline {
        std::array<glm::dvec2, 4> corners;
        double slope_x, slope_y, base;  ///< height = slope_x x + slope_y y + base
        int leaves;                     ///< 1 where a ray from within passes it, else -1
        double low_y, high_y;
    };

    std::size_t slice_of(double x) const;

    std::vector<Outline> outlines_;
    std::vector<std::vector<std::uint32_t>> slices_;  // by x
    double first_x_ = 0, slice_width_ = 1;
    mutable std::size_t looks_ = 0;
};

}  // namespace hemirad
