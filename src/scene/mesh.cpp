#include "scene/mesh.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace hemirad {
namespace {

// Half the cross product of the diagonals of a planar quad; a triangle's repeated corner makes it
// the usual one.
glm::dvec3 area_vector(const std::vector<glm::dvec3>& vertices, const Patch& patch) {
    const auto [a, b, c, d] = patch.corners;
    return 0.5 * glm::cross(vertices[c] - vertices[a], vertices[d] - vertices[b]);
}

}  // namespace

std::uint32_t Surface::side_count() const {
    return side_of_patch.empty() ? 1 : std::ranges::max(side_of_patch) + 1u;
}

std::size_t Mesh::shooter_count() const {
    return shooters.empty() ? patches.size() : shooters.size();
}

double Mesh::area(const Patch& patch) const { return glm::length(area_vector(vertices, patch)); }

glm::dvec3 Mesh::normal(const Patch& patch) const {
    const glm::dvec3 n = area_vector(vertices, patch);
    return n / glm::length(n);
}

glm::dvec3 Mesh::centroid(const Patch& patch) const {
    const glm::dvec3 &a = vertices[patch.corners[0]], &b = vertices[patch.corners[1]],
                     &c = vertices[patch.corners[2]], &d = vertices[patch.corners[3]];
    const double abc = glm::length(glm::cross(b - a, c - a));
    const double acd = glm::length(glm::cross(c - a, d - a));
    return a + (abc * (b - a + c - a) + acd * (c - a + d - a)) / (3 * (abc + acd));
}

}  // namespace hemirad
