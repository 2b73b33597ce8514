#pragma once

#include <string>

#include "extremes/solves_support.h"

/// A solve that goes on and on.
namespace hemirad::test {

/// Flux that has left the shooters so far, over what the band emits.
inline double shot_over_emitted(const Mesh& mesh, const Solution& solution, std::size_t band) {
    double arrived = solution.ledger[band].escaped;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
        arrived += solution.irradiance[band][i] * mesh.area(mesh.patches[i]);
    return arrived / solution.ledger[band].emitted;
}

/// The form factor of a shot, its product with the flux and that with the reflectance are rounded
/// by at most 2^-24 of the flux each, in the worst case all to one side: the ledger may lack three
/// times as much of all flux that was ever shot, however many shots it took. Sums add nothing to
/// it: what is received is compensated, and what is unshot starts from 0 after each shot.
inline void expect_closed_books(FormFactorMode mode, std::uint64_t shots, double patch_size = 0.5) {
    constexpr double kMostReflectance = 0.98;  // unless asked for more
    const Mesh mesh = meshed(of_reflectance(furnished_room(), kMostReflectance), patch_size);

    const Solution solution = solution_of(mesh, settings(32, mode, kEveryShot, shots));

    expect_numbers(solution);
    EXPECT_EQ(solution.shots, shots);
    EXPECT_LT(largest_residual(solution), 1e-6);
    for (std::size_t band = 0; band < solution.bands.size(); ++band)
        EXPECT_LT(solution.ledger[band].residual(),
                  3 * 0x1p-24 * shot_over_emitted(mesh, solution, band));
    testing::Test::RecordProperty("residual",
                                  std::to_string(1e6 * largest_residual(solution)) + " millionths");
}

}  // namespace hemirad::test
