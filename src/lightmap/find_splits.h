#pragma once

#include <vector>

#include "scene/mesh.h"
#include "solver/solution.h"

namespace hemirad {

/// Which patches split_mesh() should split, of a mesh that allows `levels` splits: where, in
/// any band, irradiance between the patches' centres errs by more than `bound` of its mean, as
/// neighbours of the patch's own size tell. By twice as much after each split, since a quarter of
/// the area adds as much to the mean square with twice the error.
std::vector<bool> find_splits(const Mesh& mesh, const Solution& solution, std::uint32_t levels,
                              double bound);

}  // namespace hemirad
