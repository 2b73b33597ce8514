#pragma once

#include <vector>

#include "scene/contact.h"
#include "scene/flat_faces.h"
#include "scene/group_flats.h"
#include "scene/mesh.h"
#include "scene/precision.h"
#include "scene/vertex_welder.h"

namespace hemirad::meshing {

/// A surface that is not in a mesh yet: patches and fragments count from its own first patch.
struct CutSurface {
    Surface surface;
    std::vector<Patch> patches;
    std::vector<Shooter> shooters;
    std::vector<Fragment> fragments;
};

/// How often what lies in each cell of a surface's finest grid has been split; empty: never.
using Depths = std::vector<std::uint8_t>;

/// A surface's grids, coarse to fine: that of its patches, each cell of which is a whole number of
/// cells of the first of `elements` each way, and each of these two of the next.
struct Grids {
    Surface patches;
    std::vector<Surface> elements;
    Depths depths = {};
    std::vector<Contact> contacts = {};  ///< along which the surface is cut, too
    /// Of shooters that were split once, twice, ...: each a whole number of times as fine as the
    /// one before, and from the grid that equals elements[0] on as fine as the elements.
    std::vector<Surface> split_shooters = {};
    Depths shooter_depths = {};
    bool has_fragments = true;  ///< a surface that is turned over needs none
};

enum class Merging { in_cells, none };

/// Fills the coarse grid with shooters: quads where the surface's faces fill a cell, triangles and
/// quads where its outline or a contact runs through one. These are split where shooter_depths say
/// so, as far as elements are. Then each shooter along the grid of elements, likewise, and further
/// where depths say so. The surface that comes back has the finest grid.
CutSurface cut_surface(const FlatFaces& faces, const Group& group, Grids grids, Merging merging,
                       const Precision& precision, VertexWelder& vertices);

/// The same surface as seen from behind, mirrored left to right; without fragments.
CutSurface turn_over(CutSurface front);

/// Gives the surface its place in the mesh, unless it has no patch.
void append(CutSurface cut, Mesh& mesh);

}  // namespace hemirad::meshing
