#include "solver/bands.h"

#include <algorithm>
#include <numbers>
#include <optional>

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

// Emission of band b over that of band a, where the same for every material: 1, or by their
// strongest emitters.
std::optional<double> emission_ratio(const Mesh& mesh, std::size_t a, std::size_t b) {
    const double of_a = strongest_emission(mesh, a), of_b = strongest_emission(mesh, b);
    if (of_a == 0 || of_b == 0) return of_a == of_b ? std::optional(1.0) : std::nullopt;
    for (const auto& material : mesh.materials)
        if (material.emission[a] * (of_b / of_a) != material.emission[b]) return std::nullopt;
    return of_b / of_a;
}

}  // namespace

BandPlan plan_bands(const Mesh& mesh) {
    BandPlan plan;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band) {
        std::size_t shared = 0;
        std::optional<double> ratio;
        for (; shared < plan.solved.size(); ++shared) {
            const std::size_t other = plan.solved[shared];
            if (!same_reflectance(mesh, other, band)) continue;
            if ((ratio = emission_ratio(mesh, other, band))) break;
        }
        if (!ratio) plan.solved.push_back(band);
        plan.solution.push_back(shared);
        plan.emission_scale.push_back(ratio.value_or(1.0));
    }
    return plan;
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
