#pragma once

#include <cstdint>

#include "scene/outlines.h"
#include "scene/precision.h"
#include "scene/vertex_welder.h"

namespace hemirad::meshing {

/// T-junctions: a vertex of an open edge (not passed equally often both ways) that lies within
/// Precision::plane of the interior of another open edge is moved onto that edge, the longest of
/// several, to the rounding of doubles: a file's own rounding had left a crack. A vertex whose move
/// would collapse a face stays. Returns how many have moved.
std::uint32_t move_onto_edges(const Outlines& outlines, const Precision& precision,
                              VertexWelder& vertices);

}  // namespace hemirad::meshing
