#include "solver/accuracy.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hemirad {
namespace {

// What limits a step: how the view changes over a shooter (its samples), before the outlines of
// what hides a patch (the proxels) and closed forms for near pairs only (the sampling error).
constexpr std::array<Accuracy, kFinestStep + 1> kDial = {{{128, 1, 1e-3},
                                                          {256, 2, 1e-4},
                                                          {256, 4, 1e-5},
                                                          {512, 8, 1e-6},
                                                          {512, 16, 1e-6},
                                                          {1024, 32, 1e-6}}};
// Relative error of irradiance of a step, as found in the Cornell box of 231 patches.
constexpr std::array<double, kFinestStep + 1> kExpected = {4e-2, 8e-3, 2e-3, 6e-4, 2e-4, 6e-5};

std::vector<std::vector<double>> differences(const std::vector<std::vector<double>>& a,
                                             const std::vector<std::vector<double>>& b) {
    auto result = b;
    for (std::size_t band = 0; band < b.size(); ++band)
        for (std::size_t patch = 0; patch < b[band].size(); ++patch)
            result[band][patch] = std::abs(a[band][patch] - b[band][patch]);
    return result;
}

}  // namespace

Accuracy accuracy_at(unsigned step) { return kDial[std::min(step, kFinestStep)]; }

void set_accuracy(SolverSettings& settings, const Accuracy& accuracy) {
    if (settings.resolution == 0) settings.resolution = accuracy.resolution;
    // More hemispheres are dearer than closed forms.
    const bool counts = settings.form_factor == FormFactorMode::count;
    if (settings.sampling_error == 0)
        settings.sampling_error = (counts ? 10 : 1) * accuracy.sampling_error;
    if (settings.shooter_samples == 0 && settings.form_factor == FormFactorMode::analytic)
        settings.shooter_samples = accuracy.shooter_samples;
}

unsigned first_step(double target) {
    unsigned step = 1;  // it is compared with the one before
    while (step < kFinestStep && kExpected[step - 1] > target) ++step;
    return step;
}

SolverSettings for_comparison(const SolverSettings& settings) {
    SolverSettings other = settings;
    other.parts.direct = other.parts.indirect = false;
    if (settings.shooter_samples <= 1) {
        other.shooter_samples = 2;
        return other;
    }
    other.shooter_samples = settings.shooter_samples / 2;
    other.resolution = std::max(16u, settings.resolution / 2);
    return other;
}

Solution difference(const Solution& a, const Solution& b) {
    Solution result = b;
    result.parts.clear();
    result.irradiance = differences(a.irradiance, b.irradiance);
    result.radiosity = differences(a.radiosity, b.radiosity);
    return result;
}

double missing_light(const Solution& solution) {
    double largest = 0;
    for (const Ledger& band : solution.ledger)
        if (band.unshot > 0) largest = std::max(largest, band.unshot / band.absorbed);
    return largest;
}

double relative_rms_difference(const Mesh& mesh, const Solution& a, const Solution& b) {
    double area = 0, largest = 0;
    for (const Patch& patch : mesh.patches) area += mesh.area(patch);
    for (std::size_t band = 0; band < b.irradiance.size(); ++band) {
        // Divided before they are squared: irradiances may be anywhere in a double's range.
        double mean = 0, squares = 0;
        for (std::size_t i = 0; i < mesh.patches.size(); ++i)
            mean += mesh.area(mesh.patches[i]) / area * b.irradiance[band][i];
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            const double off = a.irradiance[band][i] - b.irradiance[band][i];
            if (off == 0) continue;
            squares += mesh.area(mesh.patches[i]) / area * (off / mean) * (off / mean);
        }
        largest = std::max(largest, std::sqrt(squares));
    }
    return largest;
}

}  // namespace hemirad
