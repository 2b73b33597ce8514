#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "formfactor/polygon_factors.h"
#include "scene/mesh.h"

namespace hemirad {

/// A patch for closed forms: in double precision, with its bounding sphere; scaled, as all of its
/// scene, so that coordinates are about 1.
struct PatchShape {
    ConvexPolygon corners;
    glm::dvec3 normal, centre;
    double radius, area;
};

std::vector<PatchShape> patch_shapes(const Mesh& mesh);

/// Of Mesh::shooters.
std::vector<PatchShape> shooter_shapes(const Mesh& mesh);

}  // namespace hemirad
