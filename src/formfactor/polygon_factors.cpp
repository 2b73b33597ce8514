#include "formfactor/polygon_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formfactor/convex.h"
#include "formfactor/edge_integrals.h"

namespace hemirad {
namespace {

using formfactor::Plane;
using formfactor::Segment;
using std::numbers::pi;

// Relative to the extent of a pair; below, a polygon counts as lying in the plane of the other.
constexpr double kCoplanar = 1e-12;
constexpr double kTolerance = 1e-11;
// Sizes of the larger polygon; beyond, a rule of degree 5 leaves a relative error of 1e-9 of a
// factor of 1e-3.
constexpr double kFar = 16;

struct Weighted {
    glm::dvec3 at;
    double area;
};

// Radon (1948): seven points, exact to degree 5.
void add_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                  std::vector<Weighted>& points) {
    const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
    const double root = std::sqrt(15.0);
    const glm::dvec3 centre = (a + b + c) / 3.0;
    points.push_back({centre, area * 9 / 40});
    for (const double sign : {-1.0, 1.0})
        for (const glm::dvec3& corner : {a, b, c})
            points.push_back({centre + (corner - centre) * ((1 + sign * root) / 7),
                              area * (155 - sign * root) / 1200});
}

std::vector<Weighted> points_on(std::span<const glm::dvec3> polygon) {
    std::vector<Weighted> points;
    points.reserve(7 * polygon.size());
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        add_triangle(polygon[0], polygon[k], polygon[k + 1], points);
    return points;
}

// Area of `from` times the factor.
double exchange_by_kernel(const ConvexPolygon& from, const Plane& from_plane,
                          const ConvexPolygon& to, const Plane& to_plane) {
    const auto to_points = points_on(to);
    double sum = 0;
    for (const Weighted& x : points_on(from))
        for (const Weighted& y : to_points) {
            const glm::dvec3 gap = y.at - x.at;
            const double squared = glm::dot(gap, gap);
            sum -= x.area * y.area * glm::dot(from_plane.normal, gap) *
                   glm::dot(to_plane.normal, gap) / (squared * squared);
        }
    return sum / pi;
}

std::vector<Segment> edges_of(const ConvexPolygon& polygon, double scale) {
    std::vector<Segment> edges;
    edges.reserve(polygon.size());
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec3 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
        const double length = glm::length(edge);
        if (length > 0) edges.push_back({polygon[k] * scale, edge / length, length * scale});
    }
    return edges;
}

// Scaled by the distance of the two, so that the logarithms are small.
double exchange_by_contours(const ConvexPolygon& from, const ConvexPolygon& to, double distance) {
    const auto from_edges = edges_of(from, 1 / distance);
    const auto to_edges = edges_of(to, 1 / distance);
    const double least =
        std::min(formfactor::area(from), formfactor::area(to)) / (distance * distance);
    double sum = 0;
    for (const Segment& p : from_edges)
        for (const Segment& q : to_edges) {
            const double cosine = glm::dot(p.along, q.along);
            if (std::abs(cosine) < 1e-14) continue;
            const double tolerance = kTolerance * std::min(1.0, least / (p.length * q.length));
            sum += cosine * formfactor::log_distance(p, q, tolerance);
        }
    return sum * distance * distance / (2 * pi);
}

glm::dvec3 mean_corner(const ConvexPolygon& polygon) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& corner : polygon) sum += corner;
    return sum / double(polygon.size());
}

double exchange(const ConvexPolygon& from, const Plane& from_plane, const ConvexPolygon& to,
                const Plane& to_plane) {
    const double size = std::max(formfactor::reach(from), formfactor::reach(to));
    const double distance = glm::distance(mean_corner(from), mean_corner(to));
    if (distance > kFar * size) return exchange_by_kernel(from, from_plane, to, to_plane);
    return exchange_by_contours(from, to, std::max(distance, size));
}

ConvexPolygon moved(std::span<const glm::dvec3> polygon, const glm::dvec3& by) {
    ConvexPolygon result(polygon.begin(), polygon.end());
    for (glm::dvec3& corner : result) corner += by;
    return result;
}

}  // namespace

double point_to_polygon(const glm::dvec3& origin, const glm::dvec3& normal,
                        std::span<const glm::dvec3> to) {
    const ConvexPolygon seen = moved(to, -origin);
    if (seen.empty() || glm::dot(formfactor::vector_area(seen), seen[0]) >= 0) return 0;
    return std::min(1.0,
                    formfactor::lambert_sum(formfactor::in_front({normal, 0}, seen, 0), normal));
}

double polygon_to_polygon(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) {
    if (from.size() < 3 || to.size() < 3) return 0;
    const ConvexPolygon source = moved(from, -from[0]), target = moved(to, -from[0]);
    const Plane source_plane = formfactor::plane_of(source);
    const Plane target_plane = formfactor::plane_of(target);
    const double margin = kCoplanar * (formfactor::reach(source) + formfactor::reach(target) +
                                       glm::length(target[0]));
    const ConvexPolygon seeing = formfactor::in_front(target_plane, source, margin);
    const ConvexPolygon seen = formfactor::in_front(source_plane, target, margin);
    if (seeing.size() < 3 || seen.size() < 3) return 0;
    return std::clamp(exchange(seeing, source_plane, seen, target_plane) / formfactor::area(source),
                      0.0, 1.0);
}

}  // namespace hemirad
