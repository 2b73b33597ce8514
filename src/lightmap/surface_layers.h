#pragma once

#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "scene/mesh.h"

namespace hemirad {

/// The point of each texel's centre, world space, m. In gutters, and wherever the surface's outline
/// leaves texels of its chart free, that of its plane; 0 between charts.
Layer position_layer(const Mesh& mesh, const ChartLayout& layout);

/// The unit normal of each texel's surface, world space, towards the side that is lit; as
/// position_layer() beyond the surface.
Layer normal_layer(const Mesh& mesh, const ChartLayout& layout);

}  // namespace hemirad
