#include "solver/ambient.h"

#include "solver/bands.h"

namespace hemirad {
namespace {

/// Irradiance, W/m^2, of unshot flux that is reflected 1 + rho + rho^2 + ... times.
double ambient(const Mesh& mesh, std::size_t band, double unshot) {
    double area = 0, absorbing = 0;
    for (const Patch& patch : mesh.patches) {
        area += mesh.area(patch);
        absorbing += mesh.area(patch) * (1 - double{reflectance(mesh, patch, band)});
    }
    return absorbing > 0 ? unshot / absorbing : unshot / area;
}

}  // namespace

Solution with_ambient(const Mesh& mesh, Solution solution) {
    for (std::size_t band = 0; band < solution.bands.size(); ++band) {
        const double added = ambient(mesh, band, solution.ledger[band].unshot);
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            solution.irradiance[band][i] += added;
            solution.radiosity[band][i] += double{reflectance(mesh, mesh.patches[i], band)} * added;
        }
    }
    return solution;
}

}  // namespace hemirad
