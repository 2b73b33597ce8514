#include "cli/gather_lightmaps.h"

#include <algorithm>
#include <utility>

#include "cli/progress_display.h"
#include "cli/row_display.h"
#include "lightmap/patch_lookup.h"
#include "solver/bands.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

using Bands = std::vector<std::vector<double>>;

/// What of a light patches emit themselves, and all that they send of it, [band][patch].
struct LightSent {
    Bands own, sent;
};

Bands without(const Bands& all, const Bands& part) {
    Bands rest = all;
    for (std::size_t band = 0; band < rest.size(); ++band)
        for (std::size_t i = 0; i < rest[band].size(); ++i)
            rest[band][i] = std::max(0.0, rest[band][i] - part[band][i]);
    return rest;
}

Bands nothing(const Mesh& mesh) {
    return Bands(mesh.bands.size(), std::vector<double>(mesh.patches.size()));
}

/// Of the solution, then of its parts.
std::vector<LightSent> sent_light(const Mesh& mesh, const Solution& solution, Lights apart) {
    const LightGroups lights = group_lights(mesh, apart);
    const Bands emission = emitted_radiosities(mesh);
    std::vector<LightSent> result{{emission, solution.radiosity}};
    std::uint32_t light = 0;
    for (const SolutionPart& part : solution.parts) {
        if (part.kind == SolutionPart::Kind::light)
            result.push_back({emitted_radiosities(mesh, lights, light++), part.radiosity});
        else if (part.kind == SolutionPart::Kind::direct)
            result.push_back({emission, emission});
        else
            result.push_back({nothing(mesh), without(solution.radiosity, emission)});
    }
    return result;
}

void append(const Bands& bands, Bands& to) { to.insert(to.end(), bands.begin(), bands.end()); }

Bands irradiance_by_patch(const Solution& solution) {
    Bands all = solution.irradiance;
    for (const SolutionPart& part : solution.parts) append(part.irradiance, all);
    return all;
}

template <class Count>
std::size_t sum_of(const std::vector<GatheredLight>& atlases, const Count& count) {
    std::size_t sum = 0;
    for (const GatheredLight& atlas : atlases) sum += atlas.*count;
    return sum;
}

}  // namespace

std::size_t GatheredLightmaps::gathered() const {
    return sum_of(atlases, &GatheredLight::gathered);
}

std::size_t GatheredLightmaps::interpolated() const {
    return sum_of(atlases, &GatheredLight::interpolated);
}

GatherSettings gather_settings(const SolveOptions& options) {
    GatherSettings settings;
    settings.resolution = options.gather.value_or(settings.resolution);
    settings.form_factor = options.solver.form_factor;
    settings.pe_array = options.solver.pe_array;
    settings.variants = options.solver.variants;
    settings.kernels_dir = options.solver.kernels_dir;
    return settings;
}

std::size_t gathered_bands(const SolveOptions& options, const Mesh& mesh) {
    const auto& parts = options.solver.parts;
    return mesh.bands.size() * (1 + group_lights(mesh, parts.lights).names.size() +
                                std::size_t{parts.direct} + std::size_t{parts.indirect});
}

std::optional<GatheredLightmaps> gather_lightmaps(const SolveOptions& options, const Mesh& mesh,
                                                  const ChartLayout& layout,
                                                  const Solution& solution,
                                                  const mp1map::Device& device,
                                                  const std::function<bool()>& go_on) {
    const Stopwatch stopwatch;
    Bands sent;
    for (const LightSent& light : sent_light(mesh, solution, options.solver.parts.lights))
        append(light.sent, sent);
    Gather gather(mesh, sent, gather_settings(options), device);
    const Bands by_patch = irradiance_by_patch(solution);
    GatheredLightmaps result;
    for (std::uint32_t atlas = 0; atlas < layout.atlases.size(); ++atlas) {
        RowDisplay display(progress_style(options.quiet, options.no_progress), "texel");
        auto light = gather_light(
            mesh, layout, atlas, by_patch, options.gather_error,
            [&](std::span<const SurfacePoint> points, const TexelProgress& before) {
                return gather.irradiance(points, [&](std::size_t done) {
                    display.show(std::min(before.known + done, before.all), before.all);
                    return go_on();
                });
            });
        if (!light) return std::nullopt;
        result.atlases.push_back(std::move(*light));
    }
    result.seconds = stopwatch.seconds();
    return result;
}

void put_gathered(const SolveOptions& options, const Mesh& mesh, const Solution& solution,
                  const GatheredLight& gathered, Quantity quantity,
                  std::vector<std::vector<float>>& values) {
    const std::size_t bands = std::min(values.size(), gathered.irradiance.size());
    Bands own;
    if (quantity == Quantity::radiosity)
        for (const LightSent& light : sent_light(mesh, solution, options.solver.parts.lights))
            append(light.own, own);
    for (std::size_t band = 0; band < bands; ++band)
        for (std::size_t texel = 0; texel < values[band].size(); ++texel) {
            const std::uint32_t patch = gathered.patch[texel];
            if (patch == kNoPatch) continue;
            float& value = values[band][texel];
            value = gathered.irradiance[band][texel];
            if (quantity == Quantity::irradiance) continue;
            const double rho = reflectance(mesh, mesh.patches[patch], band % mesh.bands.size());
            value = static_cast<float>(own[band][patch] + rho * value);
        }
}

}  // namespace hemirad
