#pragma once

#include "scene/mesh.h"

namespace hemirad::meshing {

/// The scene's materials with reflectances of at most `limit`, and one warning that names those of
/// its faces' materials which were above: with a reflectance of 1 light never comes to rest.
void limit_reflectance(const Scene& scene, double limit, Mesh& mesh);

}  // namespace hemirad::meshing
