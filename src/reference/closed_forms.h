#pragma once

#include <glm/vec3.hpp>
#include <span>

namespace hemirad::reference {

/// Between two directly opposed rectangles of size width x height.
double parallel_rectangles(double width, double height, double distance);

/// From a rectangle to another at a right angle to it along a common edge; `from_depth` and
/// `to_depth` are their extents away from that edge.
double perpendicular_rectangles(double edge, double from_depth, double to_depth);

/// From a differential area at `origin` to the front of an unoccluded planar convex polygon,
/// counter-clockwise from its front, by Lambert's sum over edges; 0 from behind. What lies below
/// the horizon of `normal` (unit length) is clipped.
double point_to_polygon(const glm::dvec3& origin, const glm::dvec3& normal,
                        std::span<const glm::dvec3> corners);

}  // namespace hemirad::reference
