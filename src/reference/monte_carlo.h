#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reference/polygon.h"

namespace hemirad::reference {

struct MonteCarloFactors {
    std::vector<double> values, standard_errors;  ///< [polygon]; sqrt(F (1 - F) / rays)
    double outside = 0;
    std::uint64_t ray_count = 0;
};

/// Index of the first polygon along the ray that turns its front to it, or kEscaped.
using FirstFront = std::function<int(const glm::dvec3& origin, const glm::dvec3& direction)>;

/// From the whole of a polygon: rays from uniformly distributed points, directions distributed as
/// their cosine, so that each counts 1 / ray_count. The same seed, the same rays.
MonteCarloFactors monte_carlo_factors(const Polygon& from, std::size_t polygon_count,
                                      const FirstFront& first_front, std::uint64_t ray_count,
                                      std::uint64_t seed);

}  // namespace hemirad::reference
