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

// Twice integrated over x: ln of the distance sqrt(x^2 + h^2).
double twice_integrated(double x, double h) {
    const double squared = x * x + h * h;
    if (squared == 0) return 0;
    const double angle = h == 0 ? 0 : h * x * std::atan(x / h);
    return (x * x - h * h) * std::log(squared) / 4 + angle - 3 * x * x / 4;
}

// Integral of ln r over x in a and x' in b, at `h` across: the second difference of the above.
double between_edges(const Interval& a, const Interval& b, double h) {
    return twice_integrated(b.high - a.low, h) - twice_integrated(b.high - a.high, h) -
           twice_integrated(b.low - a.low, h) + twice_integrated(b.low - a.high, h);
}

double length(const Interval& interval) { return interval.high - interval.low; }

// Sum over the edges along x, at the ends of a and of b across it: they run the same way, so that
// ln r counts positive, where both are low or both are high.
double edges_along(const Interval& x_from, const Interval& x_to, const Interval& a,
                   const Interval& b, double distance) {
    double sum = 0;
    for (const double from : {a.low, a.high})
        for (const double to : {b.low, b.high}) {
            const double sign = (from == a.low) == (to == b.low) ? -1 : 1;
            sum += sign * between_edges(x_from, x_to, std::hypot(to - from, distance));
        }
    return sum;
}

std::vector<glm::dvec3> midpoints(const glm::dvec3& from, const glm::dvec3& to, int steps) {
    std::vector<glm::dvec3> points;
    for (int k = 0; k < steps; ++k) points.push_back(from + (k + 0.5) / steps * (to - from));
    return points;
}

// Mean of ln r between the points of two edges.
double mean_log(const std::vector<glm::dvec3>& on_a, const std::vector<glm::dvec3>& on_b) {
    double sum = 0;
    for (const glm::dvec3& p : on_a)
        for (const glm::dvec3& q : on_b) sum += std::log(glm::distance(p, q));
    return sum / (double(on_a.size()) * double(on_b.size()));
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

// Fronts that look at each other have outlines of opposite turns: where both edges are at the low
// or both at the high end across, they run against each other.
double parallel_rectangles(const Interval& from_x, const Interval& from_y, const Interval& to_x,
                           const Interval& to_y, double distance) {
    const double along_x = edges_along(from_x, to_x, from_y, to_y, distance);
    const double along_y = edges_along(from_y, to_y, from_x, to_x, distance);
    return (along_x + along_y) / (2 * pi * length(from_x) * length(from_y));
}

// Only edges along x are parallel; y and z are both across, at a right angle. Turning one plane
// into the other shows the signs: both fronts look into the same quadrant.
double perpendicular_rectangles(const Interval& from_x, const Interval& from_y,
                                const Interval& to_x, const Interval& to_z) {
    double sum = 0;
    for (const double y : {from_y.low, from_y.high})
        for (const double z : {to_z.low, to_z.high}) {
            const double sign = (y == from_y.low) == (z == to_z.low) ? -1 : 1;
            sum += sign * between_edges(from_x, to_x, std::hypot(y, z));
        }
    return sum / (2 * pi * length(from_x) * length(from_y));
}

double by_contours(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, int steps) {
    glm::dvec3 twice_area(0);
    for (std::size_t k = 1; k + 1 < from.size(); ++k)
        twice_area += glm::cross(from[k] - from[0], from[k + 1] - from[0]);
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        for (std::size_t j = 0; j < to.size(); ++j) {
            const glm::dvec3 &a = from[i], &b = from[(i + 1) % from.size()];
            const glm::dvec3 &c = to[j], &d = to[(j + 1) % to.size()];
            const double product = glm::dot(b - a, d - c);
            if (product != 0)
                sum += product * mean_log(midpoints(a, b, steps), midpoints(c, d, steps));
        }
    return sum / (pi * glm::length(twice_area));
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
