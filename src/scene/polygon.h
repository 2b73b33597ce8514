#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

namespace hemirad::meshing {

/// A vertex and where it lies in the plane of its surface.
struct Corner {
    std::uint32_t vertex;
    glm::dvec2 at;
};

/// Counter-clockwise; the last corner joins the first.
using Polygon = std::vector<Corner>;

/// Twice the area of the triangle: positive where c lies to the left of the line from a to b.
double turn(const Corner& a, const Corner& b, const Corner& c);

double area(const Polygon& polygon);

/// Height above its longest side, were it a triangle: 2 area / longest edge.
double thickness(const Polygon& polygon);

/// How far b stands out of the line from a to c: positive at a convex corner, 0 at a straight one
/// and at the tip of a spike.
double bulge(const Corner& a, const Corner& b, const Corner& c);

/// Without the corners that stand out by `precision` or less.
Polygon without_straight_corners(Polygon polygon, double precision);

/// Every corner turns left and the outline goes round once.
bool is_convex(const Polygon& polygon);

/// Two of its edges cross in their interiors (a bow-tie).
bool crosses_itself(const Polygon& polygon);

/// Of two convex polygons.
double common_area(const Polygon& a, const Polygon& b);

/// A strictly convex polygon as quads and at most one triangle.
/// Parts no thicker than `precision` are left out.
std::vector<Polygon> cut_into_quads(const Polygon& polygon, double precision);

}  // namespace hemirad::meshing
