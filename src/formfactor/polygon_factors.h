#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

/// Closed forms between unoccluded convex polygons, double precision. Polygons are planar,
/// counter-clockwise from their fronts, their last corner joins the first; a repeated corner does
/// no harm. Only fronts see and are seen.
namespace hemirad {

using ConvexPolygon = std::vector<glm::dvec3>;

/// From a differential area at `origin` with unit `normal`: Lambert's sum over the edges, of what
/// lies above the horizon.
double point_to_polygon(const glm::dvec3& origin, const glm::dvec3& normal,
                        std::span<const glm::dvec3> to);

/// From the whole of one polygon, by Stokes' theorem: double contour integral of ln r / (2 pi A),
/// one of the two in closed form. What lies behind either plane is clipped. Shared edges and
/// corners included; error below 1e-9. 0 without an area, and for polygons in one plane.
double polygon_to_polygon(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to);

}  // namespace hemirad
