#pragma once

#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "solver/solution.h"

namespace hemirad {

/// Texels from patches. A texel takes the value at its centre, interpolated bilinearly between the
/// area-weighted means of the surface's grid cells, of the patches on its own side of what stands
/// on the surface; cells without one are left out, beyond the outermost cell centres the value
/// stays constant. A constant solution gives exactly constant texels. Uncovered texels up to
/// `padding` (at least 2) from a covered one of their own chart copy the nearest; all others are 0.
Lightmap rasterize(const Mesh& mesh, const Solution& solution, const ChartLayout& layout,
                   Quantity quantity);

}  // namespace hemirad
