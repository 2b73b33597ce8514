#include "solver/patch_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "errors.h"
#include "kernels/shared.h"

namespace hemirad {
namespace {

struct Extent {
    glm::dvec3 least, most;
};

Extent extent_of(const Mesh& mesh) {
    Extent extent{mesh.vertices.front(), mesh.vertices.front()};
    for (const auto& vertex : mesh.vertices) {
        extent.least = glm::min(extent.least, vertex);
        extent.most = glm::max(extent.most, vertex);
    }
    return extent;
}

// The power of two that brings half of the largest side into [1/2, 1), on the grid too, so that
// no difference of two coordinates exceeds an int32.
double normalising_scale(const Extent& extent) {
    const glm::dvec3 half = 0.5 * extent.most - 0.5 * extent.least;
    const double largest = std::max({half.x, half.y, half.z});
    if (!(largest > 0) || !std::isfinite(largest))
        throw InputError("the scene's extent of " + std::to_string(2 * largest) +
                         " m cannot be normalised");
    int exponent = 0;  // largest = fraction * 2^exponent, fraction in [1/2, 1)
    const double fraction = std::frexp(largest, &exponent);
    return std::ldexp(1.0, 1 - fraction < kGridStep ? -exponent - 1 : -exponent);
}

bool only_triangles(const Mesh& mesh) {
    return std::all_of(mesh.patches.begin(), mesh.patches.end(),
                       [](const Patch& patch) { return patch.is_triangle(); });
}

std::array<std::int32_t, 3> on_grid(const glm::dvec3& normalised) {
    std::array<std::int32_t, 3> steps{};
    for (int axis = 0; axis < 3; ++axis)
        steps[axis] = static_cast<std::int32_t>(std::lround(normalised[axis] / kGridStep));
    return steps;
}

template <class Element, class Value>
void store(std::vector<Element>& to, std::size_t row, std::uint32_t stride, std::size_t patch,
           const Value& value) {
    for (int axis = 0; axis < 3; ++axis)
        to[(row * 3 + axis) * stride + patch] = static_cast<Element>(value[axis]);
}

}  // namespace

PatchArrays patch_arrays(const Mesh& mesh) {
    const Extent extent = extent_of(mesh);
    PatchArrays arrays;
    arrays.patch_count = static_cast<std::uint32_t>(mesh.patches.size());
    arrays.stride = (arrays.patch_count + kReduceBlock - 1) / kReduceBlock * kReduceBlock;
    arrays.corner_count = only_triangles(mesh) ? 3 : 4;
    arrays.centre = 0.5 * extent.least + 0.5 * extent.most;
    arrays.scale = normalising_scale(extent);
    arrays.corners.resize(std::size_t{3} * arrays.corner_count * arrays.stride);
    arrays.normals.resize(std::size_t{3} * arrays.stride);
    arrays.planes.resize(arrays.stride, -1);
    for (std::size_t patch = 0; patch < mesh.patches.size(); ++patch) {
        for (std::uint32_t k = 0; k < arrays.corner_count; ++k) {
            const auto& world = mesh.vertices[mesh.patches[patch].corners[k]];
            store(arrays.corners, k, arrays.stride, patch,
                  on_grid((world - arrays.centre) * arrays.scale));
        }
        store(arrays.normals, 0, arrays.stride, patch, mesh.normal(mesh.patches[patch]));
        const std::uint32_t surface = mesh.patches[patch].surface;
        arrays.planes[patch] = static_cast<std::int32_t>(mesh.surfaces[surface].plane);
    }
    return arrays;
}

double unit_scale(const Mesh& mesh) {
    double largest = 0;
    for (const glm::dvec3& vertex : mesh.vertices)
        largest = std::max({largest, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    return largest > 0 ? std::exp2(-std::ilogb(largest)) : 1;
}

}  // namespace hemirad
