#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace hemirad::reference {

/// Between two directly opposed rectangles of size width x height.
double parallel_rectangles(double width, double height, double distance);

/// From a rectangle to another at a right angle to it along a common edge; `from_depth` and
/// `to_depth` are their extents away from that edge.
double perpendicular_rectangles(double edge, double from_depth, double to_depth);

struct Interval {
    double low, high;
};

/// From a rectangle in the plane z = 0, front up, to one in the plane z = distance, front down.
double parallel_rectangles(const Interval& from_x, const Interval& from_y, const Interval& to_x,
                           const Interval& to_y, double distance);

/// From a rectangle in the plane z = 0, front up, to one in the plane y = 0 that faces towards +y.
/// y and z are extents away from the line where the planes meet, at least 0.
double perpendicular_rectangles(const Interval& from_x, const Interval& from_y,
                                const Interval& to_x, const Interval& to_z);

/// Between two convex polygons of any kind, each wholly in front of the other: Stokes' double
/// contour integral of ln r, both by the midpoint rule with `steps` steps an edge. Its error falls
/// with steps^2 where the outlines keep apart.
double by_contours(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to, int steps);

/// From a differential area at `origin` to the front of an unoccluded planar convex polygon,
/// counter-clockwise from its front, by Lambert's sum over edges; 0 from behind. What lies below
/// the horizon of `normal` (unit length) is clipped.
double point_to_polygon(const glm::dvec3& origin, const glm::dvec3& normal,
                        std::span<const glm::dvec3> corners);

}  // namespace hemirad::reference
