#include "reference/form_factor_matrix.h"

#include <glm/geometric.hpp>
#include <numeric>

namespace hemirad::reference {

double FormFactorMatrix::row_sum(std::size_t from) const {
    const auto row = values.begin() + std::ptrdiff_t(from * patch_count);
    return std::accumulate(row, row + std::ptrdiff_t(patch_count), 0.0);
}

std::vector<Shooter> shooters_on(const Polygon& polygon, int samples) {
    const glm::dvec3 u_axis = glm::normalize(polygon.corners[1] - polygon.corners[0]);
    std::vector<Shooter> shooters;
    for (const glm::dvec3& point : sample_points(polygon, samples))
        shooters.push_back({point, normal(polygon), u_axis});
    return shooters;
}

FormFactorMatrix form_factor_matrix(std::span<const Polygon> polygons,
                                    std::span<const std::vector<Shooter>> shooters,
                                    int resolution) {
    const double disk = double(disk_proxel_count(resolution));
    FormFactorMatrix matrix(polygons.size());
    std::vector<std::uint64_t> counts(polygons.size());
    for (std::size_t from = 0; from < polygons.size(); ++from) {
        counts.assign(polygons.size(), 0);
        for (const Shooter& shooter : shooters[from])
            for (const int owner : project(shooter, polygons, resolution).owner)
                if (owner >= 0) ++counts[std::size_t(owner)];
        for (std::size_t to = 0; to < polygons.size(); ++to)
            matrix.at(from, to) = double(counts[to]) / (disk * double(shooters[from].size()));
    }
    return matrix;
}

FormFactorMatrix form_factor_matrix(std::span<const Polygon> polygons, int resolution,
                                    int samples) {
    std::vector<std::vector<Shooter>> shooters;
    for (const Polygon& polygon : polygons) shooters.push_back(shooters_on(polygon, samples));
    return form_factor_matrix(polygons, shooters, resolution);
}

}  // namespace hemirad::reference
