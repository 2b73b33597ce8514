#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <random>
#include <vector>

#include "reference/projector.h"

/// Small scenes for the tests of the reference.
namespace hemirad::reference {

inline Polygon quad(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 d) {
    return {{a, b, c, d}};
}

inline Polygon triangle(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) { return {{a, b, c, c}}; }

inline Polygon reversed(const Polygon& polygon) {
    const auto& c = polygon.corners;
    return polygon.is_triangle() ? triangle(c[2], c[1], c[0]) : quad(c[3], c[2], c[1], c[0]);
}

/// At the origin, looking along z.
inline Shooter upward() { return {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}; }

/// A square of side 2 * half above the origin, its front down.
inline Polygon ceiling(double half, double height, glm::dvec2 middle = {0, 0}) {
    const auto corner = [&](double x, double y) {
        return glm::dvec3(middle.x + x, middle.y + y, height);
    };
    return quad(corner(-half, -half), corner(-half, half), corner(half, half), corner(half, -half));
}

/// The inside of the box from -half to half, each wall in cells * cells quads.
inline std::vector<Polygon> room(glm::dvec3 half, int cells = 1) {
    std::vector<Polygon> walls;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            const auto point = [&](int s, int t) {
                glm::dvec3 unit;
                unit[axis] = side;
                unit[(axis + 1) % 3] = -side * (2.0 * s / cells - 1);  // turns the front inwards
                unit[(axis + 2) % 3] = 2.0 * t / cells - 1;
                return unit * half;
            };
            for (int s = 0; s < cells; ++s)
                for (int t = 0; t < cells; ++t)
                    walls.push_back(
                        quad(point(s, t), point(s + 1, t), point(s + 1, t + 1), point(s, t + 1)));
        }
    }
    return walls;
}

inline glm::dvec3 random_point(std::mt19937& random, double half) {
    std::uniform_real_distribution<double> coordinate(-half, half);
    const double x = coordinate(random), y = coordinate(random), z = coordinate(random);
    return {x, y, z};
}

/// Triangles of about `size` anywhere in the cube from -1 to 1, across the horizon too.
inline std::vector<Polygon> soup(int count, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Polygon> triangles;
    for (int index = 0; index < count; ++index) {
        const glm::dvec3 middle = random_point(random, 1);
        const auto a = middle + random_point(random, size);
        const auto b = middle + random_point(random, size);
        const auto c = middle + random_point(random, size);
        triangles.push_back(triangle(a, b, c));
    }
    return triangles;
}

/// A frame in general position.
inline Shooter tilted() {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.5, 0.8));
    return {
        {0.02, -0.01, 0.03}, normal, glm::normalize(glm::cross(normal, glm::dvec3(0.9, 0.1, 0.4)))};
}

}  // namespace hemirad::reference
