#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/edges.h"
#include "scene/flat_faces.h"
#include "scene/mesh.h"
#include "scene/precision.h"

namespace hemirad::meshing {

struct InsideOut {
    std::uint32_t part;
    glm::dvec3 at;  ///< a corner of it
};

struct Parts {
    std::vector<Part> parts;
    std::vector<std::uint32_t> part_of_flat;
    bool encloses_all = false;  ///< every part is closed and seen from inside one
    /// A closed part with its fronts outwards that encloses all others.
    std::optional<InsideOut> inside_out = {};
};

/// Connected components over shared edges. A part is closed where every edge is passed as often one
/// way as the other, and edges on one line that are not (a T-junction: one long edge against
/// several short ones) together leave each of their vertices as often as they enter it.
Parts find_parts(const Scene& scene, const FlatFaces& faces, std::span<const Edge> edges,
                 const std::vector<glm::dvec3>& vertices, const Precision& precision);

}  // namespace hemirad::meshing
