#pragma once

#include "lightmap/chart_layout.h"

namespace hemirad {

/// Adds the triangles that have UVs of their own, but none of objects whose UVs have no area, their
/// atlases, and warnings of those that are mirrored or have no area. Throws InputError as
/// lay_out_charts() does.
void place_authored(const Scene& scene, const Mesh& mesh, const ChartSettings& settings,
                    ChartLayout& layout);

}  // namespace hemirad
