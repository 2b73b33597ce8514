#pragma once

#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "solver/solution.h"

namespace hemirad {

/// Texels of one atlas, from patches. A texel takes the value at its centre, interpolated
/// bilinearly between the area-weighted means of the surface's grid cells, of the patches on its
/// own side of what stands on the surface; cells without one are left out, beyond the outermost
/// cell centres the value stays constant, or goes on to that of the next surface in the plane. A
/// constant solution gives exactly constant texels.
/// What lies under a block shows the light beside it. Uncovered texels up to the padding from a
/// covered one of their own chart show what that patch's light would be there; all others are 0.
Lightmap rasterize(const Mesh& mesh, const Solution& solution, const ChartLayout& layout,
                   Quantity quantity, std::uint32_t atlas = 0);

}  // namespace hemirad
