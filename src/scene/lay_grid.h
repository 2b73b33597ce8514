#pragma once

#include "scene/flat_faces.h"
#include "scene/group_flats.h"
#include "scene/mesh.h"
#include "scene/precision.h"

namespace hemirad::meshing {

/// The surface of a group: its frame along the longest boundary edge (the first of equals), its
/// bounding rectangle, divided evenly into cells of about `patch_size`. Has no patches yet.
Surface lay_grid(const Scene& scene, const FlatFaces& faces, const Group& group,
                 const std::vector<glm::dvec3>& vertices, const Precision& precision,
                 double patch_size);

/// The same surface with each of its cells divided evenly into cells of about `element_size`;
/// infinity: not divided.
Surface divide_cells(const Scene& scene, const Surface& surface, const Precision& precision,
                     double element_size);

/// The same surface with 2^levels cells a side in place of each.
Surface halve_cells(const Scene& scene, const Surface& surface, std::uint32_t levels);

/// The same surface with cells of which each is divided, along each side, by the least factor of
/// the number of cells of `elements` there; not where that is one.
Surface part_cells(const Surface& surface, const Surface& elements);

}  // namespace hemirad::meshing
