#include "solver/bands.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <numbers>

#include "errors.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

// The device holds fluxes as floats, as parts of what a band emits: the smallest normal one is
// still a normal double in W. The largest is what a patch receives if every reflectance is as near
// to 1 as a float can be, 2^24 times what is emitted.
constexpr double kLeastFlux =
    std::numeric_limits<double>::min() / std::numeric_limits<float>::min();
constexpr double kMostFlux = std::numeric_limits<double>::max() * 0x1p-24;

const Material& material_of(const Mesh& mesh, const Patch& patch) {
    return mesh.materials[mesh.surfaces[patch.surface].material];
}

bool same_reflectance(const Mesh& mesh, std::size_t a, std::size_t b) {
    return std::all_of(mesh.materials.begin(), mesh.materials.end(), [&](const Material& material) {
        return material.reflectance[a] == material.reflectance[b];
    });
}

bool belongs_to(const LightGroups& lights, std::uint32_t surface, std::uint32_t light) {
    return light == kEveryLight || lights.of_surface[surface] == light;
}

// Materials of which surfaces emit a light.
std::vector<bool> materials_of(const Mesh& mesh, const LightGroups& lights, std::uint32_t light) {
    std::vector<bool> used(mesh.materials.size(), light == kEveryLight);
    if (light == kEveryLight) return used;
    for (std::size_t s = 0; s < mesh.surfaces.size(); ++s)
        if (lights.of_surface[s] == light) used[mesh.surfaces[s].material] = true;
    return used;
}

double strongest_emission(const Mesh& mesh, const std::vector<bool>& used, std::size_t band) {
    double strongest = 0;
    for (std::size_t m = 0; m < used.size(); ++m)
        if (used[m]) strongest = std::max(strongest, mesh.materials[m].emission[band]);
    return strongest;
}

// Whether band b's emission is one multiple of band a's for every material that is used.
bool proportional_emission(const Mesh& mesh, const std::vector<bool>& used, std::size_t a,
                           std::size_t b) {
    const double of_a = strongest_emission(mesh, used, a), of_b = strongest_emission(mesh, used, b);
    if (of_a == 0 || of_b == 0) return of_a == of_b;
    for (std::size_t m = 0; m < used.size(); ++m) {
        const auto& emission = mesh.materials[m].emission;
        // One material's is, but of_b / of_a is rounded.
        const bool strongest = emission[a] == of_a && emission[b] == of_b;
        if (used[m] && !strongest && emission[a] * (of_b / of_a) != emission[b]) return false;
    }
    return true;
}

double strongest_radiosity(const Mesh& mesh, std::size_t band) {
    double strongest = 0;
    for (const auto& patch : mesh.patches)
        strongest = std::max(strongest, emitted_radiosity(mesh, patch, band));
    return strongest;
}

std::string beyond(const std::string& band, double value, const char* unit) {
    char text[96];
    std::snprintf(text, sizeof text, "emits %.3g %s; light from %.2g W to %.2g W is counted", value,
                  unit, kLeastFlux, kMostFlux);
    return "band \"" + printable(band) + "\" " + text;
}

// Indices into plan.solved of the scene's bands of a light; what is not among them yet is added.
std::vector<std::size_t> add_bands(const Mesh& mesh, BandPlan& plan, std::uint32_t light,
                                   bool reflects) {
    const std::size_t first = plan.solved.size();
    const auto used = materials_of(mesh, plan.lights, light);
    std::vector<std::size_t> solution;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band) {
        const auto same =
            std::find_if(plan.solved.begin() + static_cast<std::ptrdiff_t>(first),
                         plan.solved.end(), [&](const SolvedBand& other) {
                             return (!reflects || same_reflectance(mesh, other.band, band)) &&
                                    proportional_emission(mesh, used, other.band, band);
                         });
        solution.push_back(static_cast<std::size_t>(same - plan.solved.begin()));
        if (same == plan.solved.end()) plan.solved.push_back({band, light, reflects});
    }
    return solution;
}

void require_countable(const Mesh& mesh, const BandPlan& plan) {
    for (const SolvedBand& solved : plan.solved) {
        const double flux = emitted_flux(mesh, plan.lights, solved);
        if (solved.light == kEveryLight || flux == 0 || flux >= kLeastFlux) continue;
        throw InputError("light \"" + printable(plan.lights.names[solved.light]) + "\", " +
                         beyond(mesh.bands[solved.band], flux, "W"));
    }
}

}  // namespace

std::optional<std::string> uncountable_light(const Mesh& mesh) {
    for (std::size_t band = 0; band < mesh.bands.size(); ++band) {
        const double radiosity = strongest_radiosity(mesh, band), flux = emitted_flux(mesh, band);
        if (!(radiosity <= kMostFlux)) return beyond(mesh.bands[band], radiosity, "W/m^2");
        if (radiosity > 0 && !(flux >= kLeastFlux && flux <= kMostFlux))
            return beyond(mesh.bands[band], flux, "W");
    }
    return {};
}

BandPlan plan_bands(const Mesh& mesh, const PartSettings& parts) {
    if (const auto fault = uncountable_light(mesh)) throw InputError(*fault);
    BandPlan plan{parts, {}, {}, {}, {}};
    plan.lights = group_lights(mesh, parts.lights);
    if (plan.lights.names.empty())
        plan.solution.push_back(add_bands(mesh, plan, kEveryLight, true));
    for (std::uint32_t light = 0; light < plan.lights.names.size(); ++light)
        plan.solution.push_back(add_bands(mesh, plan, light, true));
    if (parts.direct || parts.indirect) plan.direct = add_bands(mesh, plan, kEveryLight, false);
    require_countable(mesh, plan);
    return plan;
}

bool emits_light(const Mesh& mesh) {
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        if (emitted_flux(mesh, band) > 0) return true;
    return false;
}

double emitted_radiosity(const Mesh& mesh, const Patch& patch, std::size_t band) {
    return std::numbers::pi * material_of(mesh, patch).emission[band];
}

double emitted_radiosity(const Mesh& mesh, const LightGroups& lights, const Patch& patch,
                         const SolvedBand& solved) {
    if (!belongs_to(lights, patch.surface, solved.light)) return 0;
    return emitted_radiosity(mesh, patch, solved.band);
}

std::vector<std::vector<double>> emitted_radiosities(const Mesh& mesh, const LightGroups& lights,
                                                     std::uint32_t light) {
    std::vector<std::vector<double>> emitted(mesh.bands.size());
    for (std::size_t band = 0; band < emitted.size(); ++band)
        for (const Patch& patch : mesh.patches)
            emitted[band].push_back(emitted_radiosity(mesh, lights, patch, {band, light}));
    return emitted;
}

float reflectance(const Mesh& mesh, const Patch& patch, std::size_t band) {
    return static_cast<float>(material_of(mesh, patch).reflectance[band]);
}

double emitted_flux(const Mesh& mesh, std::size_t band) {
    return emitted_flux(mesh, {}, {.band = band});
}

double emitted_flux(const Mesh& mesh, const LightGroups& lights, const SolvedBand& solved) {
    double flux = 0;
    for (const auto& patch : mesh.patches)
        if (const double radiosity = emitted_radiosity(mesh, lights, patch, solved); radiosity > 0)
            flux += mesh.area(patch) * radiosity;
    return flux;
}

}  // namespace hemirad
