#pragma once

#include <span>
#include <vector>

#include "scene/cut_cells.h"
#include "scene/polygon.h"

namespace hemirad::meshing {

/// A strictly convex polygon and the pieces (indices into the cell's) that it replaces.
struct MergedPiece {
    Polygon polygon;
    std::vector<std::uint32_t> pieces;
};

/// Joins the pieces of one cell over their shared edges: all that hang together where their
/// outline is convex, else pair by pair as long as the pair is.
std::vector<MergedPiece> merge_pieces(std::span<const CellPiece> cell, double precision);

}  // namespace hemirad::meshing
