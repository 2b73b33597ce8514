#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "formfactor/polygon_factors.h"
#include "solver/patch_shapes.h"

namespace hemirad {

struct Sphere {
    glm::dvec3 centre;
    double radius;
};

/// Bounding spheres of all patches, in groups of neighbours.
class PatchSpheres {
  public:
    /// Keeps a reference.
    explicit PatchSpheres(const std::vector<PatchShape>& patches);

    /// Patches that reach into the capsule around two of them and may hide a part of the second
    /// from the first. `blockers` is overwritten.
    void between(std::uint32_t from, std::uint32_t to, std::vector<ConvexPolygon>& blockers);

  private:
    const std::vector<PatchShape>& patches_;
    std::vector<std::uint32_t> order_;  ///< neighbours next to each other
    std::vector<Sphere> spheres_;       ///< of the patches in that order
    /// Of the groups, an array a coordinate, so that the compiler takes several at a time.
    std::vector<float> group_x_, group_y_, group_z_, group_radius_;
    std::vector<std::uint8_t> touched_;  ///< groups, by the last capsule
};

}  // namespace hemirad
