#pragma once

#include <span>
#include <vector>

#include "scene/edges.h"
#include "scene/flat_faces.h"
#include "scene/precision.h"

namespace hemirad::meshing {

/// The flats of one surface, ascending.
using Group = std::vector<std::uint32_t>;

/// Maximal sets of flats of one object and material that share edges and lie, within
/// Precision::plane, in one plane with the same front; ordered by their first flat.
std::vector<Group> group_coplanar(const Scene& scene, const FlatFaces& faces,
                                  std::span<const Edge> edges,
                                  const std::vector<glm::dvec3>& vertices,
                                  const Precision& precision);

/// Every flat by itself.
std::vector<Group> group_singly(const FlatFaces& faces);

}  // namespace hemirad::meshing
