#include "reference/closed_forms.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

namespace hemirad::reference {
namespace {

using std::numbers::pi;

// The part of a convex polygon, relative to the origin, that lies above the horizon.
std::vector<glm::dvec3> clip_to_horizon(std::span<const glm::dvec3> corners,
                                        const glm::dvec3& normal) {
    std::vector<glm::dvec3> clipped;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec3 p = corners[k];
        const glm::dvec3 q = corners[(k + 1) % corners.size()];
        const double above_p = glm::dot(normal, p);
        const double above_q = glm::dot(normal, q);
        if (above_p >= 0) clipped.push_back(p);
        if ((above_p >= 0) != (above_q >= 0))
            clipped.push_back(p + above_p / (above_p - above_q) * (q - p));
    }
    return clipped;
}

// An edge's geodesic spans a sector of a great disk whose projection on the base disk has the area
// angle / 2 times the cosine of disk to base (sec. 1.3.2); over pi, the base disk's area. Signed:
// the sectors of a polygon's edges add up to its own projection.
double sector_factor(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& normal) {
    const glm::dvec3 across = glm::cross(q, p);
    const double sine = glm::length(across);
    if (sine == 0) return 0;
    const double angle = std::atan2(sine, glm::dot(p, q));
    return angle * glm::dot(normal, across / sine) / (2 * pi);
}

bool turns_its_front(std::span<const glm::dvec3> corners) {
    glm::dvec3 vector_area(0);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
        vector_area += glm::cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
    return glm::dot(vector_area, corners[0]) < 0;
}

}  // namespace

// The double area integral of cos cos / (pi r^2) is, by Stokes' theorem, the double contour
// integral of ln r / (2 pi) over both outlines. Only parallel edges count; on each such pair the
// integrand depends on the difference of two coordinates, which leaves one elementary integral a
// pair.
double parallel_rectangles(double width, double height, double distance) {
    const double x = width / distance;
    const double y = height / distance;
    const double root_x = std::sqrt(1 + x * x);
    const double root_y = std::sqrt(1 + y * y);
    const double logarithm = std::log(root_x * root_y / std::sqrt(1 + x * x + y * y));
    const double facing = x * root_y * std::atan(x / root_y) + y * root_x * std::atan(y / root_x);
    return 2 / (pi * x * y) * (logarithm + facing - x * std::atan(x) - y * std::atan(y));
}

// The same contour integral; the common edge is a pair of its own, at distance zero.
double perpendicular_rectangles(double edge, double from_depth, double to_depth) {
    const double w = from_depth / edge;
    const double h = to_depth / edge;
    const double ww = w * w;
    const double hh = h * h;
    const double diagonal = std::sqrt(ww + hh);
    const double all = 1 + ww + hh;
    const double angles =
        w * std::atan(1 / w) + h * std::atan(1 / h) - diagonal * std::atan(1 / diagonal);
    const double logarithms = std::log((1 + ww) * (1 + hh) / all) +
                              ww * std::log(ww * all / ((1 + ww) * (ww + hh))) +
                              hh * std::log(hh * all / ((1 + hh) * (ww + hh)));
    return (angles + logarithms / 4) / (pi * w);
}

double point_to_polygon(const glm::dvec3& origin, const glm::dvec3& normal,
                        std::span<const glm::dvec3> corners) {
    std::vector<glm::dvec3> seen(corners.begin(), corners.end());
    for (glm::dvec3& corner : seen) corner -= origin;
    if (!turns_its_front(seen)) return 0;
    seen = clip_to_horizon(seen, normal);
    double factor = 0;
    for (std::size_t k = 0; k < seen.size(); ++k)
        factor += sector_factor(seen[k], seen[(k + 1) % seen.size()], normal);
    return factor;
}

}  // namespace hemirad::reference
