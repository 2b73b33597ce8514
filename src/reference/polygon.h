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

/// Below this height over a polygon's plane a point counts as in the plane: it sees neither side.
/// So a sheet's front does not see the back of the same sheet, which rounding may put before it.
double least_height(const Polygon& polygon);

/// samples * samples points, one for each equal part of the polygon: the centres of a quad's cells,
/// bilinear in its corners, or the centroids of a triangle's congruent sub-triangles.
std::vector<glm::dvec3> sample_points(const Polygon& polygon, int samples);

/// Share of the area that each of these points stands for; they differ where a quad is no
/// parallelogram.
std::vector<double> sample_shares(const Polygon& polygon, int samples);

}  // namespace hemirad::reference
