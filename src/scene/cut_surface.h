#pragma once

#include <vector>

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
    std::vector<Fragment> fragments;
};

enum class Merging { in_cells, none };

/// Fills the surface's grid with patches: quads where its faces fill a cell, triangles and quads
/// where its outline runs through one.
CutSurface cut_surface(const FlatFaces& faces, const Group& group, Surface surface, Merging merging,
                       const Precision& precision, VertexWelder& vertices);

/// The same surface as seen from behind, mirrored left to right; without fragments.
CutSurface turn_over(CutSurface front);

/// Gives the surface its place in the mesh, unless it has no patch.
void append(CutSurface cut, Mesh& mesh);

}  // namespace hemirad::meshing
