#pragma once

#include "scene/mesh.h"
#include "solver/solution.h"

namespace hemirad {

/// The solution so far with what is still unshot spread evenly over all patches, as if none of it
/// escaped: the ambient term of Cohen et al. (1988). Only for looking at while a solve goes
/// on; ledger and unshot fraction stay.
Solution with_ambient(const Mesh& mesh, Solution solution);

}  // namespace hemirad
