#pragma once

#include "scene/mesh.h"

namespace hemirad {

/// Of the pairs of a patch and another the share in which it sees the other, by rays between the
/// middles of some thousands of them; the same for the same mesh.
double seen_share(const Mesh& mesh);

}  // namespace hemirad
