#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace hemirad::meshing {

/// What two coordinates of a scene must differ by to differ at all. Files carry floats or about six
/// decimal digits, and both are absolute once objects have been placed: the largest coordinate
/// decides, not the size of a face.
struct Precision {
    double weld;   ///< m; closer vertices are one: four float ulps of the largest coordinate
    double plane;  ///< m; twice that, as welding may have moved a vertex by `weld`: closer to a
                   ///< plane or a line is on it
};

Precision precision_of(const std::vector<glm::dvec3>& positions);

}  // namespace hemirad::meshing
