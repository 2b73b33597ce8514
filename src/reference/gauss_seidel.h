#pragma once

#include <span>
#include <vector>

#include "reference/form_factor_matrix.h"

namespace hemirad::reference {

/// Flux of one band, in the unit of radiosity times area: emitted = absorbed + escaped.
struct Balance {
    double emitted = 0, absorbed = 0, escaped = 0;
};

/// One band of the radiosity equation (eq. 1.1), solved.
struct BandSolution {
    std::vector<double> radiosity;   ///< own emission included
    std::vector<double> irradiance;  ///< sum over i of F_ji B_i
    Balance balance;
    int sweeps = 0;
    bool converged = false;
};

/// What is known of one band; each span has an entry for every patch.
struct Band {
    std::span<const double> reflectance;  ///< in [0, 1]
    std::span<const double> emitted;      ///< E, the radiosity of its own: pi * radiance
};

/// Gauss-Seidel on B_j = E_j + rho_j * sum_i F_ji B_i. The matrix holds the shooter's factors, from
/// which reciprocity makes F_ji = F_ij A_i / A_j. Stops where no radiosity is expected to move by
/// more than `tolerance` of itself.
BandSolution solve(const FormFactorMatrix& form_factor, std::span<const double> areas,
                   const Band& band, double tolerance = 1e-12, int max_sweeps = 100000);

/// The same for every band of a scene.
std::vector<BandSolution> solve(const FormFactorMatrix& form_factor, std::span<const double> areas,
                                std::span<const Band> bands, double tolerance = 1e-12,
                                int max_sweeps = 100000);

}  // namespace hemirad::reference
