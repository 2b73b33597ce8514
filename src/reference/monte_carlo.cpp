#include "reference/monte_carlo.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <random>

#include "reference/projector.h"

namespace hemirad::reference {
namespace {

using glm::dvec3;

/// In [0, 1), of 53 bits; the library's own distributions differ from one to the next.
class Uniform {
  public:
    explicit Uniform(std::uint64_t seed) : random_(seed) {}
    double operator()() { return double(random_() >> 11) * 0x1p-53; }

  private:
    std::mt19937_64 random_;
};

// Square root of one coordinate spreads points evenly over a triangle; a quad is two triangles.
dvec3 point_on(const Polygon& polygon, Uniform& uniform) {
    const auto& c = polygon.corners;
    const double first = area({{c[0], c[1], c[2], c[2]}});
    const bool in_first = uniform() * area(polygon) < first;
    const dvec3 b = in_first ? c[1] : c[2];
    const dvec3 d = in_first ? c[2] : c[3];
    const double outwards = std::sqrt(uniform());
    const double across = uniform();
    return c[0] + outwards * ((1 - across) * (b - c[0]) + across * (d - c[0]));
}

// Even over the base disk is as the cosine over the hemisphere (sec. 1.3.2, Nusselt).
dvec3 direction_about(const glm::dmat3& axes, Uniform& uniform) {
    const double rr = uniform();
    const double angle = 2 * std::numbers::pi * uniform();
    const double r = std::sqrt(rr);
    return axes * dvec3(r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - rr));
}

glm::dmat3 axes_of(const Polygon& polygon) {
    const dvec3 u_axis = glm::normalize(polygon.corners[1] - polygon.corners[0]);
    const dvec3 up = normal(polygon);
    return {u_axis, glm::cross(up, u_axis), up};
}

}  // namespace

MonteCarloFactors monte_carlo_factors(const Polygon& from, std::size_t polygon_count,
                                      const FirstFront& first_front, std::uint64_t ray_count,
                                      std::uint64_t seed) {
    Uniform uniform(seed);
    const glm::dmat3 axes = axes_of(from);
    std::vector<std::uint64_t> hits(polygon_count);
    std::uint64_t escaped = 0;
    for (std::uint64_t ray = 0; ray < ray_count; ++ray) {
        const dvec3 origin = point_on(from, uniform);
        const int polygon = first_front(origin, direction_about(axes, uniform));
        ++(polygon == kEscaped ? escaped : hits[std::size_t(polygon)]);
    }
    MonteCarloFactors factors;
    const double rays = double(ray_count);
    for (const std::uint64_t count : hits) {
        const double value = double(count) / rays;
        factors.values.push_back(value);
        factors.standard_errors.push_back(std::sqrt(value * (1 - value) / rays));
    }
    factors.outside = double(escaped) / rays;
    factors.ray_count = ray_count;
    return factors;
}

}  // namespace hemirad::reference
