#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "solver/solution.h"

namespace hemirad {

/// [part] "direct", "indirect", or "light.NAME", all different: as the EXR's layers and the CSV's
/// columns are called. NAME is the light's, every byte but ASCII letters, digits, _ and - as %NN,
/// because a dot parts layers, and tools differ over the rest; beyond 120 bytes it ends in ~ and
/// the light's number.
std::vector<std::string> part_names(const Solution& solution);

/// What a part holds, for people: `light "lamp"`.
std::string part_meaning(const SolutionPart& part);

}  // namespace hemirad
