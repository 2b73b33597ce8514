#include "lightmap/find_splits.h"

#include <algorithm>
#include <cmath>

#include "lightmap/cell_values.h"

namespace hemirad {
namespace {

std::vector<double> areas_of(const Mesh& mesh, const Surface& surface) {
    std::vector<double> areas;
    for (std::uint32_t i = 0; i < surface.patch_count; ++i)
        areas.push_back(mesh.area(mesh.patches[surface.first_patch + i]));
    return areas;
}

double mean_of(const Mesh& mesh, const std::vector<double>& values) {
    double area = 0, sum = 0;
    for (const Surface& surface : mesh.surfaces) {
        if (!surface.has_chart) continue;
        for (std::uint32_t p = surface.first_patch; p < surface.first_patch + surface.patch_count;
             ++p) {
            const double own = mesh.area(mesh.patches[p]);
            area += own;
            sum += own * values[p];
        }
    }
    return area > 0 ? sum / area : 0;
}

// Along one axis: a quarter of what the value stands out of the line between its neighbours, which
// is what a split finds of a curve; at an end, where nothing is known beyond, of the step.
double change(double before, double here, double after) {
    if (std::isnan(before) && std::isnan(after)) return 0;
    if (std::isnan(before)) return std::abs(after - here) / 4;
    if (std::isnan(after)) return std::abs(before - here) / 4;
    return std::abs(before - 2 * here + after) / 4;
}

double error_of(const CellValues& cells, const Surface& surface, std::uint32_t i) {
    const std::uint32_t scale = surface.scale_of_patch[i];
    const std::int64_t x = (surface.cell_of_patch[i] % surface.columns) >> scale;
    const std::int64_t y = (surface.cell_of_patch[i] / surface.columns) >> scale;
    const auto at = [&](std::int64_t column, std::int64_t row) {
        return cells.at_scale(scale, column, row);
    };
    return std::max(change(at(x - 1, y), at(x, y), at(x + 1, y)),
                    change(at(x, y - 1), at(x, y), at(x, y + 1)));
}

void add_splits(const Mesh& mesh, const Surface& surface, std::span<const double> values,
                double most, int levels, std::vector<bool>& split) {
    const auto cells = cell_values_by_side(
        surface, areas_of(mesh, surface), values.subspan(surface.first_patch, surface.patch_count));
    for (std::uint32_t i = 0; i < surface.patch_count; ++i)
        if (error_of(cells[surface.side(i)], surface, i) >
            std::ldexp(most, levels - surface.scale_of_patch[i]))
            split[surface.first_patch + i] = true;
}

}  // namespace

std::vector<bool> find_splits(const Mesh& mesh, const Solution& solution, std::uint32_t levels,
                              double bound) {
    std::vector<bool> split(mesh.patches.size(), false);
    for (const auto& values : solution.irradiance) {
        const double most = bound * mean_of(mesh, values);
        for (const Surface& surface : mesh.surfaces)
            if (surface.has_chart && !surface.scale_of_patch.empty())
                add_splits(mesh, surface, values, most, static_cast<int>(levels), split);
    }
    return split;
}

}  // namespace hemirad
