#include "cli/layered_lightmap.h"

#include <utility>

#include "lightmap/part_names.h"
#include "lightmap/rasterize.h"
#include "lightmap/surface_layers.h"
#include "lightmap/write_exr.h"
#include "solver/bands.h"

namespace hemirad {
namespace {

using Bands = std::vector<std::vector<double>>;

/// A layer that is made from values of the patches, [band][patch].
struct PatchLayer {
    std::string name, meaning;
    const Bands* bands;
};

const Bands& bands_of(const auto& light, Quantity quantity) {
    return quantity == Quantity::irradiance ? light.irradiance : light.radiosity;
}

std::vector<PatchLayer> part_layers(const Solution& solution, Quantity quantity) {
    std::vector<PatchLayer> layers;
    const auto names = part_names(solution);
    for (std::size_t i = 0; i < names.size(); ++i)
        layers.push_back({names[i],
                          name_of(quantity) + " of " + part_meaning(solution.parts[i]) + ", W/m^2",
                          &bands_of(solution.parts[i], quantity)});
    return layers;
}

/// One pass over the charts makes the bands of all of them.
Lightmap rasterize_together(const SolveOptions& options, const Mesh& mesh,
                            const ChartLayout& layout, std::uint32_t atlas,
                            const Solution& solution, const std::vector<PatchLayer>& layers,
                            const GatheredLightmaps* gathered) {
    Solution all;
    all.irradiance = bands_of(solution, options.quantity);
    for (const PatchLayer& layer : layers)
        all.irradiance.insert(all.irradiance.end(), layer.bands->begin(), layer.bands->end());
    all.bands.resize(all.irradiance.size());
    Lightmap lightmap = rasterize(mesh, all, layout, Quantity::irradiance, atlas);
    // The layers of the solution's parts come first, as their light does in what was gathered.
    if (gathered != nullptr)
        put_gathered(options, mesh, solution, gathered->atlases[atlas], options.quantity,
                     lightmap.values);
    lightmap.bands = solution.bands;
    auto next = lightmap.values.begin() + static_cast<std::ptrdiff_t>(solution.bands.size());
    for (const PatchLayer& layer : layers) {
        Layer made{{}, {}, layer.meaning};
        for (std::size_t band = 0; band < solution.bands.size(); ++band)
            made.values.push_back(std::move(*next++));
        lightmap.layers[layer.name] = std::move(made);
    }
    lightmap.values.resize(solution.bands.size());
    return lightmap;
}

// Without a patch: for the names alone.
Solution nothing_of(const SolveOptions& options, const Mesh& mesh) {
    const Bands empty(mesh.bands.size());
    const auto& parts = options.solver.parts;
    Solution nothing;
    nothing.bands = mesh.bands;
    nothing.irradiance = nothing.radiosity = empty;
    using Kind = SolutionPart::Kind;
    for (const auto& name : group_lights(mesh, parts.lights).names)
        nothing.parts.push_back({Kind::light, name, empty, empty, {}});
    if (parts.direct) nothing.parts.push_back({Kind::direct, "", empty, empty, {}});
    if (parts.indirect) nothing.parts.push_back({Kind::indirect, "", empty, empty, {}});
    return nothing;
}

}  // namespace

Lightmap layered_lightmap(const SolveOptions& options, const Mesh& mesh, const ChartLayout& layout,
                          std::uint32_t atlas, const Solution& solution, const Solution* error,
                          const GatheredLightmaps* gathered) {
    const Bands emission = options.layers.emission ? emitted_radiosities(mesh) : Bands{};
    auto layers = part_layers(solution, options.quantity);
    if (options.layers.emission)
        layers.push_back({"emission", "own radiosity, pi times the radiance, W/m^2", &emission});
    if (error != nullptr)
        layers.push_back({"error",
                          "estimated error of the " + name_of(options.quantity) + ", W/m^2",
                          &bands_of(*error, options.quantity)});
    Lightmap lightmap =
        rasterize_together(options, mesh, layout, atlas, solution, layers, gathered);
    if (options.layers.normal) lightmap.layers["normal"] = normal_layer(mesh, layout, atlas);
    if (options.layers.position) lightmap.layers["position"] = position_layer(mesh, layout, atlas);
    if (options.solver.count_shots)
        lightmap.layers["shots"] = shots_layer(mesh, layout, solution.shots_of, atlas);
    return lightmap;
}

void check_channels(const SolveOptions& options, const Mesh& mesh) {
    const Solution nothing = nothing_of(options, mesh);
    ChartLayout no_charts;
    no_charts.atlases.resize(1);
    require_channel_names(layered_lightmap(options, mesh, no_charts, 0, nothing,
                                           options.estimate_error ? &nothing : nullptr));
}

}  // namespace hemirad
