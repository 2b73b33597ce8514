#pragma once

#include <glm/geometric.hpp>
#include <span>

#include "formfactor/polygon_factors.h"

namespace hemirad::formfactor {

/// Twice the area, along the normal towards the front.
glm::dvec3 vector_area(std::span<const glm::dvec3> polygon);

inline double area(std::span<const glm::dvec3> polygon) {
    return 0.5 * glm::length(vector_area(polygon));
}

/// normal * p = offset; `normal` of unit length, or zero where the polygon has no area.
struct Plane {
    glm::dvec3 normal{};
    double offset = 0;

    double height(const glm::dvec3& p) const { return glm::dot(normal, p) - offset; }
};

/// Through a polygon, in front where its front is.
Plane plane_of(std::span<const glm::dvec3> polygon);

/// What is in front of a plane (Sutherland and Hodgman 1974). Empty where nothing rises above it
/// by more than `margin`.
ConvexPolygon in_front(const Plane& plane, std::span<const glm::dvec3> polygon, double margin);

/// Longest distance from the first corner.
double reach(std::span<const glm::dvec3> polygon);

/// Lambert's sum over the edges of a polygon that lies above the horizon and turns its front to
/// the origin.
double lambert_sum(std::span<const glm::dvec3> polygon, const glm::dvec3& normal);

}  // namespace hemirad::formfactor
