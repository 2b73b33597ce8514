#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "lightmap/chart_layout.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// A triangle of an input polygon and where it lies in the lightmap.
struct UvTriangle {
    std::uint32_t face = 0;   ///< of Scene::faces
    bool is_back = false;     ///< the face as seen from behind, which has texels of its own
    std::uint32_t atlas = 0;  ///< which of the lightmap's images
    /// Which of Face::vertices, counter-clockwise as seen from the side that the triangle shows.
    std::array<std::uint32_t, 3> corners{};
    /// Of these corners, in [0, 1]: U to the right, V down from the top row as in glTF, or up from
    /// the bottom row where ChartSettings::flip_v asks for it.
    std::array<glm::dvec2, 3> uvs{};
};

/// In the order of the faces, each one's fronts before its backs. Of faces with UVs of their own
/// (ChartSource::authored) these come back, and no backs. Every face that was not dropped
/// has triangles that cover it; all of a face and side lie in one atlas and, where it is planar, in
/// one chart, so that a corner has the same UV in each of them.
std::vector<UvTriangle> lightmap_uvs(const Scene& scene, const Mesh& mesh,
                                     const ChartLayout& layout);

}  // namespace hemirad
