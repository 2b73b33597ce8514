#pragma once

#include <cstdint>
#include <vector>

#include "scene/disjoint_sets.h"
#include "scene/mesh.h"

namespace hemirad {

/// A patch has two: 2 * patch in front, 2 * patch + 1 behind.
inline std::uint32_t front_of(std::uint32_t patch) { return 2 * patch; }
inline std::uint32_t back_of(std::uint32_t patch) { return 2 * patch + 1; }

/// The mesh's vertices, those within rounding of each other drawn together.
struct MergedVertices {
    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> of;  ///< [vertex of the mesh]
};

MergedVertices merged_vertices(const Mesh& mesh);

/// Joins the sides of patches that bound the same space: around an edge, what each side looks at is
/// the next patch that meets the edge. Patches that share a part of an edge only are found as well.
/// Where a patch ends and nothing meets it, its two sides are one; where roundings leave open which
/// comes first, all of them are.
meshing::DisjointSets join_sides(const Mesh& mesh, const MergedVertices& vertices);

}  // namespace hemirad
