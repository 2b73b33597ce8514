#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "scene/mesh.h"

/// Scenes small enough to check with a pencil.
namespace hemirad {

inline constexpr double kUncut = std::numeric_limits<double>::infinity();

inline Material grey(double reflectance = 0.5) { return {"grey", {reflectance}, {0.0}, false}; }

inline Scene empty_scene() {
    Scene scene;
    scene.file = "hand.obj";
    scene.bands = {"grey"};
    scene.materials = {grey()};
    scene.objects = {"thing"};
    return scene;
}

inline void add_face(Scene& scene, const std::vector<glm::dvec3>& corners,
                     std::uint32_t material = 0, std::uint32_t object = 0) {
    Face face{{}, material, object};
    for (const auto& corner : corners) {
        face.vertices.push_back(static_cast<std::uint32_t>(scene.positions.size()));
        scene.positions.push_back(corner);
    }
    scene.faces.push_back(face);
}

inline Scene scene_of(const std::vector<std::vector<glm::dvec3>>& faces) {
    Scene scene = empty_scene();
    for (const auto& face : faces) add_face(scene, face);
    return scene;
}

/// In the plane z = 0, front up.
inline std::vector<glm::dvec3> rectangle(double x0, double y0, double x1, double y1) {
    return {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
}

inline std::vector<std::vector<glm::dvec3>> halves(const std::vector<glm::dvec3>& quad) {
    return {{quad[0], quad[1], quad[2]}, {quad[0], quad[2], quad[3]}};
}

inline std::vector<glm::dvec3> reversed(std::vector<glm::dvec3> face) {
    return {face.rbegin(), face.rend()};
}

/// Six quads, fronts outside.
inline std::vector<std::vector<glm::dvec3>> solid_box(glm::dvec3 low, glm::dvec3 high) {
    const auto p = [&](int x, int y, int z) {
        return glm::dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    return {{p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0)},
            {p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)},
            {p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)},
            {p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0)},
            {p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)},
            {p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1)}};
}

/// Six quads, fronts inside.
inline std::vector<std::vector<glm::dvec3>> room(glm::dvec3 low, glm::dvec3 high) {
    auto faces = solid_box(low, high);
    for (auto& face : faces) face = reversed(face);
    return faces;
}

inline Mesh mesh_of(const Scene& scene, double patch_size, Backfaces backfaces = Backfaces::cull) {
    return build_mesh(scene, {.patch_size = patch_size, .backfaces = backfaces});
}

inline Mesh mesh_of(const std::vector<std::vector<glm::dvec3>>& faces, double patch_size,
                    Backfaces backfaces = Backfaces::cull) {
    return mesh_of(scene_of(faces), patch_size, backfaces);
}

inline std::vector<glm::dvec3> corners_of(const Mesh& mesh, const Patch& patch) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < (patch.is_triangle() ? 3 : 4); ++i)
        corners.push_back(mesh.vertices[patch.corners[i]]);
    return corners;
}

inline double total_area(const Mesh& mesh) {
    double total = 0;
    for (const Patch& patch : mesh.patches) total += mesh.area(patch);
    return total;
}

inline std::uint32_t back_count(const Mesh& mesh) {
    std::uint32_t count = 0;
    for (const Surface& surface : mesh.surfaces) count += surface.is_back ? surface.patch_count : 0;
    return count;
}

/// Of the corner that comes nearest to a straight angle, over all patches.
inline double smallest_sine(const Mesh& mesh) {
    double smallest = 1;
    for (const Patch& patch : mesh.patches) {
        const auto corners = corners_of(mesh, patch);
        const std::size_t n = corners.size();
        for (std::size_t i = 0; i < n; ++i) {
            const glm::dvec3 in = corners[(i + 1) % n] - corners[i];
            const glm::dvec3 out = corners[(i + 2) % n] - corners[(i + 1) % n];
            const double sine = glm::dot(glm::cross(in, out), mesh.normal(patch)) /
                                (glm::length(in) * glm::length(out));
            smallest = std::min(smallest, sine);
        }
    }
    return smallest;
}

}  // namespace hemirad
