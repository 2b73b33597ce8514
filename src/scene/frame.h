#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace hemirad::meshing {

/// Orthonormal, right-handed coordinates of a plane.
struct Frame {
    glm::dvec3 origin, u, v, normal;

    glm::dvec2 project(const glm::dvec3& p) const {
        return {glm::dot(p - origin, u), glm::dot(p - origin, v)};
    }
};

/// The first axis along `direction`, as far as the plane of the unit `normal` allows. Divides by
/// lengths, as glm::normalize multiplies by a rounded inverse and (L, 0, 0) would not become
/// exactly (1, 0, 0).
inline Frame frame_along(const glm::dvec3& origin, const glm::dvec3& direction,
                         const glm::dvec3& normal) {
    const glm::dvec3 across = glm::cross(normal, direction);
    const glm::dvec3 v = across / glm::length(across);
    const glm::dvec3 u = glm::cross(v, normal);
    return {origin, u / glm::length(u), v, normal};
}

}  // namespace hemirad::meshing
