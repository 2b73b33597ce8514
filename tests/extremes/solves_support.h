#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/support.h"

namespace hemirad {

/// For the names of tests.
inline void PrintTo(FormFactorMode mode, std::ostream* out) {
    *out << (mode == FormFactorMode::count ? "count" : "analytic");
}

}  // namespace hemirad

/// Rooms, settings and checks of solves at the extremes.
namespace hemirad::test {

inline constexpr double kEveryShot = 0;  ///< a tolerance that no solve reaches while there is flux

inline SolverSettings settings(std::uint32_t resolution, FormFactorMode mode, double tolerance,
                               std::uint64_t max_shots = kAnyShots) {
    auto result = settings(resolution, tolerance, max_shots);
    result.form_factor = mode;
    result.sampling_error = 1e-4;
    return result;
}

inline Scene of_reflectance(Scene scene, double reflectance) {
    for (auto& material : scene.materials)
        material.reflectance.assign(scene.bands.size(), reflectance);
    return scene;
}

inline std::string name_of(FormFactorMode mode) { return testing::PrintToString(mode); }

/// No value of a solution is below 0, infinite or no number at all.
inline void expect_numbers(const Solution& solution) {
    const auto expect_within = [](const std::vector<std::vector<double>>& bands) {
        for (const auto& band : bands)
            for (const double value : band) EXPECT_TRUE(std::isfinite(value) && value >= 0);
    };
    expect_within(solution.irradiance);
    expect_within(solution.radiosity);
    for (const Ledger& ledger : solution.ledger)
        for (const double flux : {ledger.emitted, ledger.absorbed, ledger.escaped, ledger.unshot})
            EXPECT_TRUE(std::isfinite(flux) && flux >= 0) << flux;
}

inline double largest_residual(const Solution& solution) {
    double largest = 0;
    for (const Ledger& ledger : solution.ledger) largest = std::max(largest, ledger.residual());
    return largest;
}

}  // namespace hemirad::test
