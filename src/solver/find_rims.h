#pragma once

#include <cstdint>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// For each patch a bit for each edge, from corner k to the next of so many corners (3 where all
/// patches are triangles, else 4), beyond which its plane does not go on: no patch that faces the
/// same way in the same plane shares the edge.
std::vector<std::uint8_t> find_rims(const Mesh& mesh, std::uint32_t corner_count);

}  // namespace hemirad
