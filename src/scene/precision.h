#pragma once

#include "scene/scene.h"

namespace hemirad::meshing {

/// What two places of a scene must differ by to differ at all.
struct Precision {
    double weld;   ///< m; closer vertices are one
    double plane;  ///< m; twice that, as welding may have moved a vertex by `weld`: closer to a
                   ///< plane or a line is on it
};

/// From Scene::quantum, if `weld` is 0. Throws InputError for a `weld` that the scene does not
/// allow and for coordinates beyond what is computed with.
Precision precision_of(const Scene& scene, double weld);

}  // namespace hemirad::meshing
