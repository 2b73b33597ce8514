#pragma once

#include <cstdint>

#include "scene/mesh.h"
#include "solver/solution.h"
#include "solver/solver.h"

/// The dial that trades time for accuracy, and what it came to.
namespace hemirad {

/// Steps of the dial; `hemirad tradeoff` and docs/accuracy.md say where they come from. Each takes
/// some four times as long as the one before.
enum class Quality : unsigned { draft, medium, high, ultra };
constexpr unsigned kFinestStep = 5;

struct Accuracy {
    std::uint32_t resolution, shooter_samples;
    double sampling_error;
};

/// Step 0 is Quality::draft; the steps beyond Quality::ultra are for target errors only.
Accuracy accuracy_at(unsigned step);

/// Fills in what the settings leave open: a resolution, samples or sampling error of 0. Counted
/// form factors keep samples of 0: their number then goes by the sampling error, patch by patch.
void set_accuracy(SolverSettings& settings, const Accuracy& accuracy);

/// The first step that may differ from the one before by less than `target`, of the mean
/// irradiance.
unsigned first_step(double target);

/// Other settings, whose solution differs from that of `settings` by about the larger of the two
/// errors: half of the samples and proxels; or twice the samples where there is one.
SolverSettings for_comparison(const SolverSettings& settings);

/// |a - b| of irradiance and radiosity, patch by patch, of all light; the rest is b's.
Solution difference(const Solution& a, const Solution& b);

/// Flux that is still to be shot over the flux absorbed so far, and so the share of the light that
/// is missing if all of it is absorbed in the end: the largest of the bands, infinite where nothing
/// is absorbed.
double missing_light(const Solution& solution);

/// Root of the mean over area of (a - b)^2, of the patches' irradiance, relative to b's mean; the
/// largest of the bands.
double relative_rms_difference(const Mesh& mesh, const Solution& a, const Solution& b);

}  // namespace hemirad
