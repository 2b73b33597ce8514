#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <vector>

namespace hemirad::reference {

/// A planar convex polygon, counter-clockwise from its front; a triangle repeats its last corner.
struct Polygon {
    std::array<glm::dvec3, 4> corners;

    bool is_triangle() const { return corners[3] == corners[2]; }
};

double area(const Polygon& polygon);
glm::dvec3 normal(const Polygon& polygon);  ///< unit, towards the front; zero where area is zero

/// samples * samples points, one for each equal part of the polygon: the centres of a quad's cells,
/// bilinear in its corners, or the centroids of a triangle's congruent sub-triangles.
std::vector<glm::dvec3> sample_points(const Polygon& polygon, int samples);

}  // namespace hemirad::reference
