#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reference/projector.h"

namespace hemirad::reference {

/// All form factors of a scene, the O(N^2) storage of sec. 1.2.
struct FormFactorMatrix {
    std::size_t patch_count = 0;
    std::vector<double> values;  ///< F_ij at from * patch_count + to

    explicit FormFactorMatrix(std::size_t count) : patch_count(count), values(count * count) {}
    double& at(std::size_t from, std::size_t to) { return values[from * patch_count + to]; }
    double at(std::size_t from, std::size_t to) const { return values[from * patch_count + to]; }
    double row_sum(std::size_t from) const;  ///< 1 less the fraction that escapes
};

/// samples * samples hemispheres on a polygon; u along the edge from the first to the second
/// corner.
std::vector<Shooter> shooters_on(const Polygon& polygon, int samples);

/// F_ij as the fraction of the disk's proxels that patch j owns (sec. 1.3.2), over all hemispheres
/// of patch i. `shooters` holds at least one for each polygon.
FormFactorMatrix form_factor_matrix(std::span<const Polygon> polygons,
                                    std::span<const std::vector<Shooter>> shooters, int resolution);

/// The same with the hemispheres of shooters_on.
FormFactorMatrix form_factor_matrix(std::span<const Polygon> polygons, int resolution,
                                    int samples = 1);

}  // namespace hemirad::reference
