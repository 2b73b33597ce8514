#pragma once

#include <memory>
#include <span>

#include "reference/polygon.h"

namespace hemirad::reference {

/// RayCaster's work done by Embree, in single precision: a ray through an edge may end on either
/// side of it, and a polygon is not seen from closer to its plane than 1e-6 of the scene's extent.
class EmbreeCaster {
  public:
    explicit EmbreeCaster(std::span<const Polygon> polygons);
    ~EmbreeCaster();
    EmbreeCaster(EmbreeCaster&&) noexcept;

    /// Index of the nearest polygon that turns its front to the ray, or kEscaped.
    int operator()(const glm::dvec3& origin, const glm::dvec3& direction) const;

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

}  // namespace hemirad::reference
