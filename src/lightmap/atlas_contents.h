#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lightmap/chart_layout.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// What lies in an atlas.
struct AtlasContents {
    std::uint32_t width = 0, height = 0;  ///< texels
    double texel_size = 0;                ///< m, that of a mean texel; 0 where nothing lies in it
    double filled = 0;                    ///< texels, the area of its triangles
    /// Generated ones, and of the scene's own UVs what hangs together corner by corner.
    std::size_t chart_count = 0;
    std::vector<std::uint32_t> objects = {};  ///< of Scene::objects, in that order
};

/// Of every atlas of the layout.
std::vector<AtlasContents> atlas_contents(const Scene& scene, const Mesh& mesh,
                                          const ChartLayout& layout);

}  // namespace hemirad
