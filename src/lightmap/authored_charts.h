#pragma once

#include "lightmap/chart_layout.h"

namespace hemirad {

/// Whether the scene's own UVs put this triangle into the lightmap.
bool is_authored(const Scene& scene, const FaceTriangle& triangle, ChartSource source);

/// Adds the triangles that have UVs of their own, their atlases, and warnings of those that are
/// mirrored or have no area. Throws InputError as lay_out_charts() does.
void place_authored(const Scene& scene, const Mesh& mesh, const ChartSettings& settings,
                    ChartLayout& layout);

}  // namespace hemirad
