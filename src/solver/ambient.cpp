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

void add_ambient(const Mesh& mesh, std::size_t band, double unshot, std::vector<double>& irradiance,
                 std::vector<double>& radiosity) {
    const double added = ambient(mesh, band, unshot);
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        irradiance[i] += added;
        radiosity[i] += double{reflectance(mesh, mesh.patches[i], band)} * added;
    }
}

// All of it is indirect: where unshot light comes from is not told from where it goes.
double unshot_of(const Solution& solution, const SolutionPart& part, std::size_t band) {
    switch (part.kind) {
        case SolutionPart::Kind::light:
            return part.ledger[band].unshot;
        case SolutionPart::Kind::direct:
            return 0;
        case SolutionPart::Kind::indirect:
            return solution.ledger[band].unshot;
    }
    return 0;
}

}  // namespace

Solution with_ambient(const Mesh& mesh, Solution solution) {
    for (std::size_t band = 0; band < solution.bands.size(); ++band) {
        add_ambient(mesh, band, solution.ledger[band].unshot, solution.irradiance[band],
                    solution.radiosity[band]);
        for (auto& part : solution.parts)
            add_ambient(mesh, band, unshot_of(solution, part, band), part.irradiance[band],
                        part.radiosity[band]);
    }
    return solution;
}

}  // namespace hemirad
