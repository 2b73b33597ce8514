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

double least_height(const Polygon& polygon) {
    constexpr double kInPlane = 1e-9;  // of the size: far above what doubles round
    const auto& c = polygon.corners;
    return kInPlane * (glm::distance(c[0], c[2]) + glm::distance(c[1], c[3]));
}

std::vector<glm::dvec3> sample_points(const Polygon& polygon, int samples) {
    return polygon.is_triangle() ? triangle_points(polygon, samples)
                                 : quad_points(polygon, samples);
}

std::vector<double> sample_shares(const Polygon& polygon, int samples) {
    const double even = 1 / double(samples * samples);
    std::vector<double> shares(std::size_t(samples) * samples, even);
    if (polygon.is_triangle()) return shares;
    const auto& c = polygon.corners;
    for (std::size_t cell = 0; cell < shares.size(); ++cell) {
        const double s = (double(cell % samples) + 0.5) / samples;
        const double t = (double(cell / samples) + 0.5) / samples;
        const glm::dvec3 along_s = (1 - t) * (c[1] - c[0]) + t * (c[2] - c[3]);
        const glm::dvec3 along_t = (1 - s) * (c[3] - c[0]) + s * (c[2] - c[1]);
        shares[cell] *= glm::length(glm::cross(along_s, along_t)) / area(polygon);
    }
    return shares;
}

}  // namespace hemirad::reference
