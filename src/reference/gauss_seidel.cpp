#include "reference/gauss_seidel.h"

#include <algorithm>
#include <cmath>

namespace hemirad::reference {
namespace {

// H_j = sum over i of F_ji B_i, where A_j F_ji = A_i F_ij: the flux of i to j over the area of j.
double gather(const FormFactorMatrix& form_factor, std::span<const double> areas,
              std::span<const double> radiosity, std::size_t to) {
    double flux = 0;
    for (std::size_t from = 0; from < areas.size(); ++from)
        flux += form_factor.at(from, to) * areas[from] * radiosity[from];
    return flux / areas[to];
}

// Eq. 1.1 for each patch in turn, with what the sweep has already renewed (sec. 1.2, [2]).
// Returns the largest change of a radiosity, relative to itself.
double sweep(const FormFactorMatrix& form_factor, std::span<const double> areas, const Band& band,
             std::vector<double>& radiosity) {
    double largest = 0;
    for (std::size_t to = 0; to < areas.size(); ++to) {
        const double irradiance = gather(form_factor, areas, radiosity, to);
        const double renewed = band.emitted[to] + band.reflectance[to] * irradiance;
        const double change = std::abs(renewed - radiosity[to]);
        if (change > 0) largest = std::max(largest, change / renewed);
        radiosity[to] = renewed;
    }
    return largest;
}

Balance balance_of(const FormFactorMatrix& form_factor, std::span<const double> areas,
                   const Band& band, const BandSolution& solution) {
    Balance balance;
    for (std::size_t patch = 0; patch < areas.size(); ++patch) {
        const double received = areas[patch] * solution.irradiance[patch];
        const double sent = areas[patch] * solution.radiosity[patch];
        balance.emitted += areas[patch] * band.emitted[patch];
        balance.absorbed += (1 - band.reflectance[patch]) * received;
        balance.escaped += sent * (1 - form_factor.row_sum(patch));
    }
    return balance;
}

}  // namespace

BandSolution solve(const FormFactorMatrix& form_factor, std::span<const double> areas,
                   const Band& band, double tolerance, int max_sweeps) {
    // A change of 1 still to come is followed by changes of rho, rho^2, ...: 1 / (1 - rho) in all.
    const double brightest = band.reflectance.empty() ? 0.0 : std::ranges::max(band.reflectance);
    const double largest_change = tolerance * (1 - brightest);
    BandSolution solution;
    solution.radiosity.assign(band.emitted.begin(), band.emitted.end());
    while (!solution.converged && solution.sweeps < max_sweeps) {
        ++solution.sweeps;
        solution.converged = sweep(form_factor, areas, band, solution.radiosity) <= largest_change;
    }
    for (std::size_t patch = 0; patch < areas.size(); ++patch)
        solution.irradiance.push_back(gather(form_factor, areas, solution.radiosity, patch));
    solution.balance = balance_of(form_factor, areas, band, solution);
    return solution;
}

std::vector<BandSolution> solve(const FormFactorMatrix& form_factor, std::span<const double> areas,
                                std::span<const Band> bands, double tolerance, int max_sweeps) {
    std::vector<BandSolution> solutions;
    for (const Band& band : bands)
        solutions.push_back(solve(form_factor, areas, band, tolerance, max_sweeps));
    return solutions;
}

}  // namespace hemirad::reference
