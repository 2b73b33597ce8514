#include "solver/bands.h"

#include <algorithm>
#include <numbers>

namespace hemirad {
namespace {

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

}  // namespace

BandPlan plan_bands(const Mesh& mesh) {
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
