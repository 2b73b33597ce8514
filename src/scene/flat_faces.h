#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/outlines.h"
#include "scene/precision.h"
#include "scene/scene.h"

namespace hemirad::meshing {

/// A planar, simple polygon: an input face, or a triangle of one that is not planar.
struct Flat {
    std::uint32_t face;
    std::uint32_t first_corner, corner_count;
    std::uint32_t first_triangle, triangle_count;  ///< none where the outline is convex
    bool has_reverse;                              ///< another face is its other side
};

struct FlatFaces {
    std::vector<Flat> flats;  ///< in the order of their faces
    std::vector<std::uint32_t> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of concave outlines
    std::uint32_t degenerate_count = 0, crossing_count = 0, duplicate_count = 0, split_count = 0;
    std::vector<std::string> warnings;

    std::span<const std::uint32_t> outline(const Flat& flat) const {
        return {corners.data() + flat.first_corner, flat.corner_count};
    }
    /// Convex polygons, possibly with straight corners, that make up the flat.
    std::vector<std::span<const std::uint32_t>> pieces(const Flat& flat) const;
};

/// Drops faces without area, that repeat another or that cross themselves; splits those that are
/// not planar. Each with a warning.
FlatFaces flatten(const Scene& scene, const Outlines& outlines,
                  const std::vector<glm::dvec3>& vertices, const Precision& precision);

/// Its length is the area, its direction the front (Newell's method, Sutherland et al. 1974).
glm::dvec3 area_vector(std::span<const std::uint32_t> outline,
                       const std::vector<glm::dvec3>& vertices);

/// Length of the longest edge.
double longest_edge(std::span<const std::uint32_t> outline,
                    const std::vector<glm::dvec3>& vertices);

}  // namespace hemirad::meshing
