#include "solver/find_shooter_splits.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "formfactor/polygon_factors.h"
#include "solver/patch_shapes.h"

namespace hemirad {
namespace {

double mean_irradiance(const Mesh& mesh, std::span<const PatchShape> patches,
                       std::span<const double> irradiance) {
    double area = 0, flux = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        if (!mesh.surfaces[mesh.patches[i].surface].has_chart) continue;
        area += patches[i].area;
        flux += patches[i].area * irradiance[i];
    }
    return area > 0 ? flux / area : 0;
}

// Of elements' radiosity from their mean, in `unit`. Differences from the first, so that what is
// equal differs by nothing.
std::vector<double> deviations(std::span<const PatchShape> elements,
                               std::span<const double> radiosity, double unit) {
    double area = 0, sum = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        area += elements[i].area;
        sum += elements[i].area * ((radiosity[i] - radiosity[0]) / unit);
    }
    std::vector<double> result;
    for (std::size_t i = 0; i < elements.size(); ++i)
        result.push_back((radiosity[i] - radiosity[0]) / unit - sum / area);
    return result;
}

double largest_of(std::span<const std::vector<double>> deviations) {
    double largest = 0;
    for (const auto& band : deviations)
        for (const double deviation : band) largest = std::max(largest, std::abs(deviation));
    return largest;
}

// Deviations add up to nothing, so what they do falls with the cube of the distance, and its square
// over all that lies beyond one with that distance's inverse cube: 4 % are beyond three radii.
bool is_near(const PatchShape& shooter, const PatchShape& receiver) {
    constexpr double kRadii = 3;
    const glm::dvec3 gap = receiver.centre - shooter.centre;
    return glm::dot(gap, shooter.normal) > 0 &&
           glm::length(gap) < kRadii * shooter.radius + receiver.radius;
}

// Adds the receiver's, by band.
void add_squares(const PatchShape& receiver, std::span<const PatchShape> elements,
                 std::span<const std::vector<double>> deviations, std::span<double> squares) {
    std::vector<double> errors(deviations.size(), 0);
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const double factor =
            point_to_polygon(receiver.centre, receiver.normal, elements[i].corners);
        for (std::size_t band = 0; band < errors.size(); ++band)
            errors[band] += factor * deviations[band][i];
    }
    for (std::size_t band = 0; band < errors.size(); ++band)
        squares[band] += receiver.area * errors[band] * errors[band];
}

/// What is the same for every shooter.
struct Scenery {
    const Mesh& mesh;
    const Solution& solution;
    std::vector<PatchShape> patches, shooters;
    std::vector<double> means;  ///< irradiance, by band
};

Scenery scenery_of(const Mesh& mesh, const Solution& solution) {
    Scenery scenery{mesh, solution, patch_shapes(mesh), shooter_shapes(mesh), {}};
    for (const auto& band : solution.irradiance)
        scenery.means.push_back(mean_irradiance(mesh, scenery.patches, band));
    return scenery;
}

// By lit band, in its mean irradiance.
std::vector<std::vector<double>> deviations_of(const Scenery& scenery, const Shooter& shooter) {
    std::vector<std::vector<double>> result;
    const auto own = [&](const auto& values) {
        return std::span(values).subspan(shooter.first_patch, shooter.patch_count);
    };
    for (std::size_t band = 0; band < scenery.means.size(); ++band)
        if (scenery.means[band] > 0)
            result.push_back(deviations(own(scenery.patches), own(scenery.solution.radiosity[band]),
                                        scenery.means[band]));
    return result;
}

double square_of_error(const Scenery& scenery, std::size_t index,
                       std::span<const std::vector<double>> deviations) {
    const Shooter& shooter = scenery.mesh.shooters[index];
    const auto elements =
        std::span(scenery.patches).subspan(shooter.first_patch, shooter.patch_count);
    std::vector<double> squares(deviations.size(), 0);
    for (std::size_t i = 0; i < scenery.patches.size(); ++i) {
        const std::uint32_t surface = scenery.mesh.patches[i].surface;
        if (surface == shooter.surface || !scenery.mesh.surfaces[surface].has_chart) continue;
        if (is_near(scenery.shooters[index], scenery.patches[i]))
            add_squares(scenery.patches[i], elements, deviations, squares);
    }
    return *std::ranges::max_element(squares);
}

bool is_worth_a_split(const Scenery& scenery, std::size_t index, double bound) {
    const Shooter& shooter = scenery.mesh.shooters[index];
    const double area = scenery.shooters[index].area;
    const double most = bound * bound * std::ldexp(area, 2 * static_cast<int>(shooter.splits));
    const auto deviations = deviations_of(scenery, shooter);
    // No receiver errs by more than the largest deviation times its factor, which is at most 1, and
    // areas times factors add up to the shooter's area.
    const double largest = largest_of(deviations);
    if (largest * largest * area <= most) return false;
    return square_of_error(scenery, index, deviations) > most;
}

}  // namespace

std::vector<bool> find_shooter_splits(const Mesh& mesh, const Solution& solution, double bound) {
    const Scenery scenery = scenery_of(mesh, solution);
    std::vector<bool> split;
    for (std::size_t i = 0; i < mesh.shooters.size(); ++i)
        split.push_back(is_worth_a_split(scenery, i, bound));
    return split;
}

}  // namespace hemirad
