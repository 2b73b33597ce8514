#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "support/pipeline.h"

/// Patches, shots and stacks as a test loads them into one kernel, and the kernels' arithmetic one
/// value at a time: std::fma where they say fma, in their order, so that results agree in bits.
namespace hemirad::test {

/// A convex planar polygon of 3 or 4 corners on a circle of `radius` about `centre`.
inline Polygon random_polygon(std::mt19937& random, glm::dvec3 centre, double radius, int corners) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    const auto vector = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    const auto u = glm::normalize(vector());
    const auto v = glm::normalize(glm::cross(u, vector()));
    std::vector<double> angles(corners);
    std::generate(angles.begin(), angles.end(), [&] { return angle(random); });
    std::sort(angles.begin(), angles.end());
    Polygon polygon;
    for (int k = 0; k < 4; ++k) {
        const double at = angles[std::min(k, corners - 1)];
        polygon.corners[k] = centre + radius * (std::cos(at) * u + std::sin(at) * v);
    }
    return polygon;
}

/// Patches all over the cube [-1, 1]^3: with `corners` 4, every third is a triangle.
inline PatchArrays random_patches(int count, int corners, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> inside(-0.9, 0.9);
    std::vector<Polygon> polygons;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 centre(inside(random), inside(random), inside(random));
        const int own = i % 3 == 0 ? 3 : corners;
        polygons.push_back(random_polygon(random, centre, 0.05 + 0.3 * (i % 7) / 7, own));
    }
    return patch_arrays(mesh_of(polygons));
}

/// A point of the normalised scene as whole steps of the device's grid.
using Steps = std::array<std::int32_t, 3>;

inline Steps on_grid(const glm::dvec3& point) {
    Steps steps{};
    for (int axis = 0; axis < 3; ++axis)
        steps[axis] = static_cast<std::int32_t>(std::lround(point[axis] / kGridStep));
    return steps;
}
inline glm::dvec3 exact(const Steps& steps) {
    return double{kGridStep} * glm::dvec3(steps[0], steps[1], steps[2]);
}

/// A running shot of patch 0 from a hemisphere at `origin` that looks along `normal`.
inline device::Shot shot_from(glm::dvec3 origin, glm::dvec3 normal) {
    const auto n = glm::normalize(normal);
    const auto u = glm::normalize(
        glm::cross(std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0), n));
    const auto v = glm::cross(n, u);
    device::Shot shot{};
    for (int axis = 0; axis < 3; ++axis) {
        shot.origin[axis] = on_grid(origin)[axis];
        shot.u_axis[axis] = static_cast<float>(u[axis]);
        shot.v_axis[axis] = static_cast<float>(v[axis]);
        shot.normal[axis] = static_cast<float>(n[axis]);
    }
    shot.status = kRunning;
    shot.plane = -1;
    shot.reached = -1;
    return shot;
}

/// How a shape deals `stride` patches out to the stacks of its PEs, two arrays of them.
struct Stacks {
    mp1map::Grid grid;
    std::uint32_t depth;

    Stacks(const Shape& shape, std::uint32_t stride)
        : grid{5, std::size_t{shape.width} * shape.height} {  // odd, more than two: see stacks.clh
        const auto pes = static_cast<std::uint32_t>(count());
        depth =
            ((stride + pes - 1) / pes + kClusterPatches - 1) / kClusterPatches * kClusterPatches;
    }
    std::size_t count() const { return grid.groups * grid.local; }
    std::size_t slots() const { return count() * depth; }
};

struct Scalar3 {
    float x, y, z;
};

inline float scalar_dot(Scalar3 a, Scalar3 b) {
    return std::fma(a.x, b.x, std::fma(a.y, b.y, a.z * b.z));
}
inline float scalar_dot(const float* axis, Scalar3 a) {
    return std::fma(a.x, axis[0], std::fma(a.y, axis[1], a.z * axis[2]));
}
inline Scalar3 scalar_difference(Scalar3 a, Scalar3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Scalar3 scalar_cross(Scalar3 a, Scalar3 b) {
    return {std::fma(a.y, b.z, -(a.z * b.y)), std::fma(a.z, b.x, -(a.x * b.z)),
            std::fma(a.x, b.y, -(a.y * b.x))};
}
inline Steps corner_of(const PatchArrays& arrays, std::size_t patch, std::size_t k) {
    const std::int32_t* const at = arrays.corners.data() + 3 * k * arrays.stride + patch;
    return {at[0], at[arrays.stride], at[2 * arrays.stride]};
}
inline Scalar3 normal_of(const PatchArrays& arrays, std::size_t patch) {
    const float* const at = arrays.normals.data() + patch;
    return {at[0], at[arrays.stride], at[2 * arrays.stride]};
}
inline Scalar3 relative_to(const device::Shot& shot, const Steps& a) {
    const auto along = [&](int axis) {
        return static_cast<float>(a[axis] - shot.origin[axis]) * kGridStep;
    };
    return {along(0), along(1), along(2)};
}
inline Scalar3 rotated_into(const device::Shot& shot, Scalar3 a) {
    return {scalar_dot(shot.u_axis, a), scalar_dot(shot.v_axis, a), scalar_dot(shot.normal, a)};
}

}  // namespace hemirad::test
