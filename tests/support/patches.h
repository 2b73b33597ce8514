#pragma once

#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "reference/projector.h"
#include "scene/mesh.h"
#include "solver/patch_arrays.h"

/// Scenes for tests, made patch by patch, without reader or mesher.
namespace hemirad::test {

using reference::Polygon;

/// A square of `side` about `centre`, spanned by u and v; its front is towards u x v.
inline Polygon square(glm::dvec3 centre, glm::dvec3 u, glm::dvec3 v, double side) {
    const glm::dvec3 a = 0.5 * side * u, b = 0.5 * side * v;
    return {{centre - a - b, centre + a - b, centre + a + b, centre - a + b}};
}

/// A grey mesh of one band in which every polygon is a patch and a surface of its own.
inline Mesh mesh_of(const std::vector<Polygon>& polygons, double reflectance = 0.5,
                    double radiance = 1.0) {
    Mesh mesh;
    mesh.bands = {"Y"};
    mesh.objects = {"object"};
    mesh.materials = {{"wall", {reflectance}, {radiance}, false}};
    for (const auto& polygon : polygons) {
        Patch patch{};
        for (int k = 0; k < 4; ++k) {
            if (k == 3 && polygon.is_triangle()) {
                patch.corners[3] = patch.corners[2];
                break;
            }
            patch.corners[k] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(polygon.corners[k]);
        }
        patch.surface = static_cast<std::uint32_t>(mesh.surfaces.size());
        Surface surface;
        surface.first_patch = patch.surface;
        surface.patch_count = 1;
        surface.cell_of_patch = {0};
        mesh.surfaces.push_back(surface);
        mesh.patches.push_back(patch);
    }
    return mesh;
}

/// The polygons as the device sees them: normalised, in double precision.
inline std::vector<Polygon> normalised(const std::vector<Polygon>& polygons,
                                       const PatchArrays& arrays) {
    auto result = polygons;
    for (auto& polygon : result)
        for (auto& corner : polygon.corners) corner = (corner - arrays.centre) * arrays.scale;
    return result;
}

/// Closed box [-x, x] x [-y, y] x [-z, z], fronts inwards, every wall cut into cells x cells.
inline std::vector<Polygon> box(glm::dvec3 half, int cells) {
    std::vector<Polygon> polygons;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            glm::dvec3 normal(0), u(0), v(0);
            normal[axis] = -side;
            u[(axis + 1) % 3] = -side;  // u x v = normal
            v[(axis + 2) % 3] = 1;
            const auto at = [&](int i, int j) {
                return -normal * half[axis] + u * half[(axis + 1) % 3] * (2.0 * i / cells - 1) +
                       v * half[(axis + 2) % 3] * (2.0 * j / cells - 1);
            };
            for (int j = 0; j < cells; ++j)
                for (int i = 0; i < cells; ++i)
                    polygons.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}});
        }
    return polygons;
}

/// `count` random triangles in the cube [-1, 1]^3, of sides up to `size`, above a unit square at
/// index 0 that looks up from z = -0.9.
inline std::vector<Polygon> soup(int count, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> inside(-1, 1);
    const auto point = [&] { return glm::dvec3(inside(random), inside(random), inside(random)); };
    std::vector<Polygon> polygons = {square({0.1, -0.05, -0.9}, {1, 0, 0}, {0, 1, 0}, 1.0)};
    while (static_cast<int>(polygons.size()) <= count) {
        const auto centre = point();
        const auto a = centre + size * point(), b = centre + size * point(),
                   c = centre + size * point();
        polygons.push_back({{a, b, c, c}});
    }
    return polygons;
}

}  // namespace hemirad::test
