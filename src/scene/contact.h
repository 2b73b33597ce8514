#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "scene/polygon.h"

namespace hemirad::meshing {

/// An edge of another surface that lies on this one, in this one's coordinates (as Corner::at):
/// where a block that stands on it ends.
struct Contact {
    glm::dvec2 from, to;

    double length() const { return glm::distance(from, to); }
};

/// How far a point is from the contact.
double distance(const Contact& contact, const glm::dvec2& at);

/// Whether the contact runs along the edge from a to b, within `slack`, for more than that.
bool runs_along(const Contact& contact, const glm::dvec2& a, const glm::dvec2& b, double slack);

/// Those of the contacts whose lines the polygon reaches: no other comes within `slack` of it.
std::vector<Contact> about(const Polygon& polygon, std::span<const Contact> contacts, double slack);

}  // namespace hemirad::meshing
