#pragma once

#include <cstdint>
#include <vector>

#include "scene/flat_faces.h"
#include "scene/group_flats.h"
#include "scene/mesh.h"
#include "scene/polygon.h"
#include "scene/precision.h"
#include "scene/vertex_welder.h"

namespace hemirad::meshing {

/// The part of one convex piece of an input face that lies in one cell.
struct CellPiece {
    std::uint32_t cell;
    std::uint32_t face;
    Polygon polygon;
};

/// Cuts the group's faces along the surface's grid, to Precision::plane; sorted by cell. New
/// vertices go to the welder.
std::vector<CellPiece> cut_into_cells(const FlatFaces& faces, const Group& group,
                                      const Surface& surface, const Precision& precision,
                                      VertexWelder& vertices);

/// The same of one convex polygon in the surface's plane; `face` is what its pieces say.
std::vector<CellPiece> cut_into_cells(const Polygon& polygon, std::uint32_t face,
                                      const Surface& surface, const Precision& precision,
                                      VertexWelder& vertices);

}  // namespace hemirad::meshing
