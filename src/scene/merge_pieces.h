#pragma once

#include <span>
#include <vector>

#include "scene/contact.h"
#include "scene/cut_cells.h"
#include "scene/polygon.h"

namespace hemirad::meshing {

/// A strictly convex polygon and the pieces (indices into the cell's) that it replaces.
struct MergedPiece {
    Polygon polygon;
    std::vector<std::uint32_t> pieces;
};

/// Contacts, and how near to one an edge runs along it: over such edges nothing is joined.
struct Barriers {
    std::span<const Contact> contacts = {};
    double slack = 0;

    bool part(const Corner& a, const Corner& b) const;
};

/// Joins the pieces of one cell over their shared edges: all that hang together where their
/// outline is convex, else pair by pair as long as the pair is. What is joined has no barrier
/// inside.
std::vector<MergedPiece> merge_pieces(std::span<const CellPiece> cell, double precision,
                                      const Barriers& barriers = {});

}  // namespace hemirad::meshing
