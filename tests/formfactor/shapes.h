#pragma once

#include <glm/geometric.hpp>
#include <random>

#include "formfactor/polygon_factors.h"

/// Polygons of any number of corners for the tests of the closed forms.
namespace hemirad::test {

/// In the plane z = height, from (x0, y0) to (x1, y1).
inline ConvexPolygon facing_up(double x0, double y0, double x1, double y1, double height = 0) {
    return {{x0, y0, height}, {x1, y0, height}, {x1, y1, height}, {x0, y1, height}};
}

inline ConvexPolygon reversed(const ConvexPolygon& polygon) {
    return {polygon.rbegin(), polygon.rend()};
}

inline ConvexPolygon facing_down(double x0, double y0, double x1, double y1, double height) {
    return reversed(facing_up(x0, y0, x1, y1, height));
}

/// In the plane y = 0, its front towards +y.
inline ConvexPolygon facing_y(double x0, double z0, double x1, double z1) {
    return {{x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}};
}

inline double area_of(const ConvexPolygon& polygon) {
    glm::dvec3 twice(0);
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        twice += glm::cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
    return glm::length(twice) / 2;
}

inline glm::dvec3 normal_of(const ConvexPolygon& polygon) {
    return glm::normalize(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]));
}

inline glm::dvec3 random_point(std::mt19937& random, double half) {
    std::uniform_real_distribution<double> coordinate(-half, half);
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    return {x, y, z};
}

/// Within a cube of side 2 * `half` about `centre`.
inline ConvexPolygon random_triangle(std::mt19937& random, const glm::dvec3& centre, double half) {
    ConvexPolygon triangle;
    for (int k = 0; k < 3; ++k) triangle.push_back(centre + random_point(random, half));
    return triangle;
}

}  // namespace hemirad::test
