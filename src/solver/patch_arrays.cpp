#include "solver/patch_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "errors.h"
#include "kernels/shared.h"
#include "solver/find_rims.h"
#include "solver/find_rooms.h"

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

// Patches or shooters, on the grid that `arrays` has.
template <class Polygons>
void store_polygons(PatchArrays& arrays, const Mesh& mesh, const Polygons& polygons) {
    arrays.patch_count = static_cast<std::uint32_t>(polygons.size());
    arrays.stride = (arrays.patch_count + kReduceBlock - 1) / kReduceBlock * kReduceBlock;
    arrays.corners.resize(std::size_t{3} * arrays.corner_count * arrays.stride);
    arrays.normals.resize(std::size_t{3} * arrays.stride);
    arrays.planes.resize(arrays.stride, -1);
    arrays.rooms.resize(arrays.stride, -1);
    arrays.reached.resize(arrays.stride, -1);
    for (std::size_t i = 0; i < polygons.size(); ++i) {
        for (std::uint32_t k = 0; k < arrays.corner_count; ++k) {
            const auto& world = mesh.vertices[polygons[i].corners[k]];
            store(arrays.corners, k, arrays.stride, i,
                  on_grid((world - arrays.centre) * arrays.scale));
        }
        const std::uint32_t surface = polygons[i].surface;
        store(arrays.normals, 0, arrays.stride, i, mesh.normal({polygons[i].corners, surface}));
        arrays.planes[i] = static_cast<std::int32_t>(mesh.surfaces[surface].plane);
    }
}

glm::dvec3 corner_of(const PatchArrays& arrays, std::size_t patch, std::size_t k) {
    const std::int32_t* const at = arrays.corners.data() + 3 * k * arrays.stride + patch;
    return double{kGridStep} * glm::dvec3(at[0], at[arrays.stride], at[2 * arrays.stride]);
}

glm::dvec3 normal_of(const PatchArrays& arrays, std::size_t patch) {
    const float* const at = arrays.normals.data() + patch;
    return {at[0], at[arrays.stride], at[2 * arrays.stride]};
}

device::Cluster cluster_of(const PatchArrays& arrays, std::size_t first) {
    constexpr double kRounding = 1e-6;
    Extent extent{corner_of(arrays, first, 0), corner_of(arrays, first, 0)};
    glm::dvec3 axis(0);
    const auto for_each_corner = [&](const auto& visit) {
        for (std::size_t patch = first; patch < first + kClusterPatches; ++patch)
            for (std::size_t k = 0; k < arrays.corner_count; ++k)
                visit(corner_of(arrays, patch, k));
    };
    for_each_corner([&](const glm::dvec3& corner) {
        extent = {glm::min(extent.least, corner), glm::max(extent.most, corner)};
    });
    for (std::size_t patch = first; patch < first + kClusterPatches; ++patch)
        axis += normal_of(arrays, patch);
    axis = glm::length(axis) > 0 ? glm::normalize(axis) : normal_of(arrays, first);

    const glm::dvec3 centre = 0.5 * (extent.least + extent.most);
    double thickness = 0, spread = 0;
    for_each_corner([&](const glm::dvec3& corner) {
        thickness = std::max(thickness, std::abs(glm::dot(axis, corner - centre)));
    });
    for (std::size_t patch = first; patch < first + kClusterPatches; ++patch)
        spread = std::max(spread, glm::distance(normal_of(arrays, patch), axis));

    device::Cluster cluster{};
    for (int i = 0; i < 3; ++i) {
        cluster.centre[i] = static_cast<float>(centre[i]);
        cluster.half_size[i] =
            static_cast<float>(0.5 * (extent.most[i] - extent.least[i]) + kRounding);
        cluster.axis[i] = static_cast<float>(axis[i]);
    }
    cluster.thickness = static_cast<float>(thickness + kRounding);
    cluster.spread = static_cast<float>(spread + kRounding);
    return cluster;
}

}  // namespace

std::vector<device::Cluster> clusters_of(const PatchArrays& arrays) {
    std::vector<device::Cluster> clusters;
    for (std::size_t first = 0; first < arrays.stride; first += kClusterPatches)
        clusters.push_back(cluster_of(arrays, first));
    return clusters;
}

std::uint32_t corner_count_of(const Mesh& mesh) {
    const auto is_triangle = [](const auto& of) { return of.corners[3] == of.corners[2]; };
    const bool only_triangles = std::ranges::all_of(mesh.patches, is_triangle) &&
                                std::ranges::all_of(mesh.shooters, is_triangle);
    return only_triangles ? 3 : 4;
}

PatchArrays patch_arrays(const Mesh& mesh, bool with_rims) {
    const Extent extent = extent_of(mesh);
    PatchArrays arrays;
    arrays.corner_count = corner_count_of(mesh);
    arrays.centre = 0.5 * extent.least + 0.5 * extent.most;
    arrays.scale = normalising_scale(extent);
    store_polygons(arrays, mesh, mesh.patches);
    const Rooms rooms = find_rooms(mesh);
    std::ranges::copy(rooms.before, arrays.rooms.begin());
    std::ranges::copy(rooms.reached, arrays.reached.begin());
    if (with_rims) arrays.rims = find_rims(mesh, arrays.corner_count);
    arrays.rims.resize(arrays.stride);
    return arrays;
}

ShooterArrays shooter_arrays(const Mesh& mesh, const PatchArrays& patches) {
    if (mesh.shooters.empty()) return {};
    ShooterArrays shooters;
    shooters.polygons.corner_count = patches.corner_count;
    shooters.polygons.centre = patches.centre;
    shooters.polygons.scale = patches.scale;
    store_polygons(shooters.polygons, mesh, mesh.shooters);
    for (std::size_t i = 0; i < mesh.shooters.size(); ++i) {
        const auto [corners, surface, first, count, splits] = mesh.shooters[i];
        shooters.polygons.reached[i] = 0;
        for (std::uint32_t patch = first; patch < first + count; ++patch)
            shooters.polygons.reached[i] |= patches.reached[patch];
    }
    for (const Shooter& shooter : mesh.shooters)
        shooters.first_patch.push_back(static_cast<std::int32_t>(shooter.first_patch));
    shooters.first_patch.resize(shooters.polygons.stride + 1,
                                static_cast<std::int32_t>(patches.patch_count));
    return shooters;
}

double unit_scale(const Mesh& mesh) {
    double largest = 0;
    for (const glm::dvec3& vertex : mesh.vertices)
        largest = std::max({largest, std::abs(vertex.x), std::abs(vertex.y), std::abs(vertex.z)});
    return largest > 0 ? std::exp2(-std::ilogb(largest)) : 1;
}

}  // namespace hemirad
