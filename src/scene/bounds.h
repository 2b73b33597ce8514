#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "scene/scene.h"

namespace hemirad {

/// A box along the axes; of no points, least is above most.
struct Bounds {
    glm::dvec3 least{std::numeric_limits<double>::infinity()};
    glm::dvec3 most{-std::numeric_limits<double>::infinity()};

    void take_in(const glm::dvec3& point) {
        least = glm::min(least, point);
        most = glm::max(most, point);
    }
    void take_in(const Bounds& other) {
        least = glm::min(least, other.least);
        most = glm::max(most, other.most);
    }
    glm::dvec3 middle() const { return 0.5 * least + 0.5 * most; }  // without overflow
    double diagonal() const { return glm::length(most - least); }
};

/// Of a range of points, of floats or doubles.
template <class Points>
Bounds bounds_of(const Points& points) {
    Bounds bounds;
    for (const auto& point : points) bounds.take_in(glm::dvec3(point));
    return bounds;
}

/// Of the positions that faces use: files hold others, too.
inline Bounds bounds_of(const Scene& scene) {
    Bounds bounds;
    for (const Face& face : scene.faces)
        for (const std::uint32_t v : face.vertices) bounds.take_in(scene.positions[v]);
    return bounds;
}

}  // namespace hemirad
