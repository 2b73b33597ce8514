#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace hemirad {

/// Convex and planar, counter-clockwise about its normal.
using Outline = std::vector<glm::dvec3>;

/// Twice the area, along the normal.
glm::dvec3 doubled_area(std::span<const glm::dvec3> outline);

bool is_in_plane_of(const Outline& outer, const Outline& inner);

/// Whether all of `inner`, in the plane of `outer`, lies within it or on its edges.
bool encloses(const Outline& outer, const Outline& inner);

/// What of a polygon lies outside of others in its plane, as convex pieces.
std::vector<Outline> cut_out(const Outline& polygon, std::span<const Outline> holes);

}  // namespace hemirad
