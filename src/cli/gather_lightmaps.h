#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "cli/solve_options.h"
#include "lightmap/chart_layout.h"
#include "lightmap/gather_light.h"
#include "lightmap/lightmap.h"
#include "mp1map/device.h"
#include "scene/mesh.h"
#include "solver/gather.h"
#include "solver/solution.h"

namespace hemirad {

/// --gather: light of every atlas, in the bands of the solution and then of each of its parts.
struct GatheredLightmaps {
    std::vector<GatheredLight> atlases;
    double seconds = 0;

    std::size_t gathered() const;      ///< texels
    std::size_t interpolated() const;  ///< texels
};

/// As the options want it; not the number of proxels.
GatherSettings gather_settings(const SolveOptions& options);

/// How many bands are gathered at once.
std::size_t gathered_bands(const SolveOptions& options, const Mesh& mesh);

/// Nothing where `go_on`, asked several times a second, says no.
std::optional<GatheredLightmaps> gather_lightmaps(const SolveOptions& options, const Mesh& mesh,
                                                  const ChartLayout& layout,
                                                  const Solution& solution,
                                                  const mp1map::Device& device,
                                                  const std::function<bool()>& go_on);

/// Takes the place of the first bands of an atlas, as many as are there and were gathered; as
/// radiosity, what the patches reflect of it and emit.
void put_gathered(const SolveOptions& options, const Mesh& mesh, const Solution& solution,
                  const GatheredLight& gathered, Quantity quantity,
                  std::vector<std::vector<float>>& values);

}  // namespace hemirad
