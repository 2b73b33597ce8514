#pragma once

#include "scene/mesh.h"
#include "scene/precision.h"

namespace hemirad::meshing {

/// Gives each surface the number of its plane. Surfaces share a number where all vertices of the
/// smaller one lie within Precision::plane of one plane, that of the largest of them or a better
/// fit to all: never from one to the next, so a curve of small steps does not drift into one.
void number_planes(const Precision& precision, Mesh& mesh);

}  // namespace hemirad::meshing
