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

double strongest_emission(const Mesh& mesh, std::size_t band) {
    double strongest = 0;
    for (const auto& material : mesh.materials)
        strongest = std::max(strongest, material.emission[band]);
    return strongest;
}

// Whether band b's emission is one multiple of band a's for every material.
bool proportional_emission(const Mesh& mesh, std::size_t a, std::size_t b) {
    const double of_a = strongest_emission(mesh, a), of_b = strongest_emission(mesh, b);
    if (of_a == 0 || of_b == 0) return of_a == of_b;
    return std::all_of(mesh.materials.begin(), mesh.materials.end(), [&](const Material& material) {
        return material.emission[a] * (of_b / of_a) == material.emission[b];
    });
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

BandPlan plan_bands(const Mesh& mesh) {
    if (const auto fault = uncountable_light(mesh)) throw InputError(*fault);
    BandPlan plan;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band) {
        const auto same =
            std::find_if(plan.solved.begin(), plan.solved.end(), [&](std::size_t other) {
                return same_reflectance(mesh, other, band) &&
                       proportional_emission(mesh, other, band);
            });
        plan.solution.push_back(static_cast<std::size_t>(same - plan.solved.begin()));
        if (same == plan.solved.end()) plan.solved.push_back(band);
    }
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

float reflectance(const Mesh& mesh, const Patch& patch, std::size_t band) {
    return static_cast<float>(material_of(mesh, patch).reflectance[band]);
}

double emitted_flux(const Mesh& mesh, std::size_t band) {
    double flux = 0;
    for (const auto& patch : mesh.patches)
        flux += mesh.area(patch) * emitted_radiosity(mesh, patch, band);
    return flux;
}

}  // namespace hemirad
