#include "reference/polygon.h"

#include <glm/geometric.hpp>

namespace hemirad::reference {
namespace {

// Twice the vector area of a planar quad is the cross product of its diagonals; with corners[3] ==
// corners[2] it is the triangle's.
glm::dvec3 twice_vector_area(const Polygon& polygon) {
    const auto& c = polygon.corners;
    return glm::cross(c[2] - c[0], c[3] - c[1]);
}

std::vector<glm::dvec3> quad_points(const Polygon& quad, int samples) {
    const auto& c = quad.corners;
    std::vector<glm::dvec3> points;
    for (int row = 0; row < samples; ++row) {
        for (int column = 0; column < samples; ++column) {
            const double s = (column + 0.5) / samples;
            const double t = (row + 0.5) / samples;
            points.push_back((1 - t) * ((1 - s) * c[0] + s * c[1]) +
                             t * ((1 - s) * c[3] + s * c[2]));
        }
    }
    return points;
}

// Cutting each side in `samples` gives samples^2 congruent triangles: a row of the grid holds
// upright ones, and one reversed between each two of them.
std::vector<glm::dvec3> triangle_points(const Polygon& triangle, int samples) {
    const auto& c = triangle.corners;
    const auto point = [&](double s, double t) {
        return c[0] + (s * (c[1] - c[0]) + t * (c[2] - c[0])) / double(samples);
    };
    std::vector<glm::dvec3> points;
    for (int row = 0; row < samples; ++row) {
        for (int column = 0; column + row < samples; ++column) {
            points.push_back(point(column + 1.0 / 3, row + 1.0 / 3));
            if (column + row + 1 < samples)
                points.push_back(point(column + 2.0 / 3, row + 2.0 / 3));
        }
    }
    return points;
}

}  // namespace

double area(const Polygon& polygon) { return glm::length(twice_vector_area(polygon)) / 2; }

glm::dvec3 normal(const Polygon& polygon) {
    const glm::dvec3 vector_area = twice_vector_area(polygon);
    const double length = glm::length(vector_area);
    return length > 0 ? vector_area / length : glm::dvec3(0);
}

std::vector<glm::dvec3> sample_points(const Polygon& polygon, int samples) {
    return polygon.is_triangle() ? triangle_points(polygon, samples)
                                 : quad_points(polygon, samples);
}

}  // namespace hemirad::reference
