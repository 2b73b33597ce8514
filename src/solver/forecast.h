#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "solver/shot_pipeline.h"

namespace hemirad {

/// What a solve will take, foretold from a few looks.
struct Forecast {
    double shots = 0;
    double looks = 0;    ///< shots whose shooter has to look; the others go by known rows
    double seconds = 0;  ///< of shooting alone, without what comes before and after
};

/// What is foretold: shots of a pipeline that has not shot yet.
struct ForecastTask {
    const PatchLight& light;
    std::vector<std::uint32_t> shooter_of;  ///< [patch]
    std::uint32_t shooters = 0;
    double tolerance = 1e-3;  ///< as SolverSettings
    std::uint64_t max_shots = 0;
    double least_seconds = 0;  ///< a solve that is shorter for certain is not foretold
    /// Asked now and then, also within a look; nothing is foretold where it says no.
    std::function<bool()> go_on;
};

/// Looks in all take this long at most, whatever the accuracy asked for.
constexpr double kMostForecastSeconds = 20;

/// Shooters of one material, or of like ones where there are many, form groups, of neighbours as
/// far as that goes, and a member of each looks. What patches receive of it is what its group
/// sends to theirs; by these factors groups shoot until the tolerance is met: the loop of sec.
/// 1.5.4 for the price of a few hundred looks, as if all members of a group had the same flux.
/// Looks and shots by known rows are timed. Nothing where so few looks as it needs would take too
/// long. Afterwards a shot at nothing is to follow, as after
/// set_state(); rows that were found are kept.
std::optional<Forecast> forecast(ShotPipeline& pipeline, const ForecastTask& task);

}  // namespace hemirad
