#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// For each patch a bit for each edge, from corner k to the next, beyond which its plane does not
/// go on: no patch that faces the same way in the same plane shares the edge.
std::vector<std::uint8_t> find_rims(const Mesh& mesh);

}  // namespace hemirad
