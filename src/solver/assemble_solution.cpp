#include "solver/assemble_solution.h"

#include <algorithm>
#include <utility>

namespace hemirad {
namespace {

using ByPatch = std::vector<double>;

double sum_of_unshot(const Mesh& mesh, const DeviceLight& light, std::size_t solved) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.shooter_count(); ++i)
        sum += light.unshot[solved * light.shooter_stride + i];
    return sum;
}

/// A scene band of a light, solved as another or not.
struct BandOfLight {
    SolvedBand band;
    std::size_t solved;
};

void add_band(const Mesh& mesh, const BandPlan& plan, const DeviceLight& light,
              const BandOfLight& of, SolutionPart& part) {
    const double emitted = emitted_flux(mesh, plan.lights, of.band);
    Ledger ledger{emitted, 0, emitted * light.escaped[of.solved],
                  emitted * sum_of_unshot(mesh, light, of.solved)};
    auto& irradiance = part.irradiance.emplace_back();
    auto& radiosity = part.radiosity.emplace_back();
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        const Patch& patch = mesh.patches[i];
        const double flux = emitted * light.received[of.solved * light.patch_stride + i];
        const double rho = reflectance(mesh, patch, of.band.band);
        irradiance.push_back(flux / mesh.area(patch));
        radiosity.push_back(emitted_radiosity(mesh, plan.lights, patch, of.band) +
                            rho * irradiance.back());
        ledger.absorbed += (1 - rho) * flux;
    }
    part.ledger.push_back(ledger);
}

SolutionPart light_part(const Mesh& mesh, const BandPlan& plan, const DeviceLight& light,
                        std::size_t row) {
    const bool together = plan.lights.names.empty();
    SolutionPart part{
        SolutionPart::Kind::light, together ? "" : plan.lights.names[row], {}, {}, {}};
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        add_band(mesh, plan, light,
                 {{band, together ? kEveryLight : static_cast<std::uint32_t>(row)},
                  plan.solution[row][band]},
                 part);
    return part;
}

void add(const std::vector<ByPatch>& values, std::vector<ByPatch>& sum, double sign = 1) {
    for (std::size_t band = 0; band < values.size(); ++band)
        for (std::size_t i = 0; i < values[band].size(); ++i)
            sum[band][i] += sign * values[band][i];
}

Solution sum_of(const std::vector<SolutionPart>& lights) {
    Solution sum;
    sum.irradiance = lights.front().irradiance;
    sum.radiosity = lights.front().radiosity;
    sum.ledger = lights.front().ledger;
    for (std::size_t light = 1; light < lights.size(); ++light) {
        add(lights[light].irradiance, sum.irradiance);
        add(lights[light].radiosity, sum.radiosity);
        for (std::size_t band = 0; band < sum.ledger.size(); ++band) {
            const Ledger& more = lights[light].ledger[band];
            sum.ledger[band].emitted += more.emitted;
            sum.ledger[band].absorbed += more.absorbed;
            sum.ledger[band].escaped += more.escaped;
            sum.ledger[band].unshot += more.unshot;
        }
    }
    return sum;
}

SolutionPart direct_part(const Mesh& mesh, const BandPlan& plan, const DeviceLight& light) {
    SolutionPart part{SolutionPart::Kind::direct, "", {}, {}, {}};
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        add_band(mesh, plan, light, {{band, kEveryLight, false}, plan.direct[band]}, part);
    part.ledger.clear();  // absorbed where it arrives, it has no books of its own
    return part;
}

// Of a patch that is lit directly alone, the two sums may differ by their roundings, either way.
SolutionPart indirect_part(const Solution& all, const SolutionPart& direct) {
    SolutionPart part{SolutionPart::Kind::indirect, "", all.irradiance, all.radiosity, {}};
    add(direct.irradiance, part.irradiance, -1);
    add(direct.radiosity, part.radiosity, -1);
    for (auto* const quantity : {&part.irradiance, &part.radiosity})
        for (auto& band : *quantity)
            for (double& value : band) value = std::max(value, 0.0);
    return part;
}

}  // namespace

Solution assemble_solution(const Mesh& mesh, const BandPlan& plan, const DeviceLight& light) {
    std::vector<SolutionPart> lights;
    for (std::size_t row = 0; row < plan.solution.size(); ++row)
        lights.push_back(light_part(mesh, plan, light, row));
    Solution solution = sum_of(lights);
    solution.bands = mesh.bands;
    if (!plan.lights.names.empty()) solution.parts = std::move(lights);
    if (plan.direct.empty()) return solution;
    SolutionPart direct = direct_part(mesh, plan, light);
    if (plan.parts.indirect) solution.parts.push_back(indirect_part(solution, direct));
    if (plan.parts.direct) solution.parts.push_back(std::move(direct));
    return solution;
}

}  // namespace hemirad
