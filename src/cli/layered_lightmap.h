#pragma once

#include "cli/gather_lightmaps.h"
#include "cli/solve_options.h"
#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "scene/mesh.h"
#include "solver/solution.h"

namespace hemirad {

/// An atlas of a solution with the layers that the options ask for; `error`, if not null, is one
/// more. What was `gathered`, if not null, takes the place of what patches tell.
Lightmap layered_lightmap(const SolveOptions& options, const Mesh& mesh, const ChartLayout& layout,
                          std::uint32_t atlas, const Solution& solution, const Solution* error,
                          const GatheredLightmaps* gathered = nullptr);

/// Before the work begins: InputError where a band's name would be that of a layer's channel.
void check_channels(const SolveOptions& options, const Mesh& mesh);

}  // namespace hemirad
