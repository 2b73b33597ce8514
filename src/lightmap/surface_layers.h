#pragma once

#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "scene/mesh.h"

namespace hemirad {

/// The point of each texel's centre, world space, m, for the texels that show something; in gutters
/// that of the surface's plane. 0 between charts.
Layer position_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas = 0);

/// The unit normal of each texel's surface, world space, towards the side that is lit; in
/// gutters, too.
Layer normal_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas = 0);

/// The shots that each texel's patch made, Solution::shots_of, nothing blended; in gutters, too.
Layer shots_layer(const Mesh& mesh, const ChartLayout& layout,
                  const std::vector<std::uint32_t>& shots_of, std::uint32_t atlas = 0);

}  // namespace hemirad
