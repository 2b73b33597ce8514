#include "formfactor/convex.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hemirad::formfactor {
namespace {

// angle * cosine of edge p, q: its sector of a great disk, projected (sec. 1.3.2).
double sector(const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& normal) {
    const glm::dvec3 across = glm::cross(q, p);
    const double sine = glm::length(across);
    if (sine == 0) return 0;
    return std::atan2(sine, glm::dot(p, q)) * glm::dot(normal, across) / sine;
}

}  // namespace

glm::dvec3 vector_area(std::span<const glm::dvec3> polygon) {
    glm::dvec3 sum(0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        sum += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return sum;
}

Plane plane_of(std::span<const glm::dvec3> polygon) {
    const glm::dvec3 along = vector_area(polygon);
    const double length = glm::length(along);
    if (length == 0) return {};
    const glm::dvec3 normal = along / length;
    return {normal, glm::dot(normal, polygon[0])};
}

ConvexPolygon in_front(const Plane& plane, std::span<const glm::dvec3> polygon, double margin) {
    ConvexPolygon kept;
    double highest = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec3& p = polygon[k];
        const glm::dvec3& q = polygon[(k + 1) % polygon.size()];
        const double p_height = plane.height(p);
        const double q_height = plane.height(q);
        highest = std::max(highest, p_height);
        if (p_height >= 0) kept.push_back(p);
        if (p_height * q_height < 0)
            kept.push_back(p + (p_height / (p_height - q_height)) * (q - p));
    }
    if (highest <= margin) kept.clear();
    return kept;
}

double reach(std::span<const glm::dvec3> polygon) {
    double longest = 0;
    for (const glm::dvec3& corner : polygon)
        longest = std::max(longest, glm::distance(corner, polygon[0]));
    return longest;
}

double lambert_sum(std::span<const glm::dvec3> polygon, const glm::dvec3& normal) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k)
        sum += sector(polygon[k], polygon[(k + 1) % polygon.size()], normal);
    return std::max(0.0, sum / (2 * std::numbers::pi));
}

}  // namespace hemirad::formfactor
