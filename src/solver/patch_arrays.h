#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "kernels/shared.h"
#include "scene/mesh.h"

namespace hemirad {

/// The mesh as the PEs hold it: structure of arrays, corners on a grid of whole steps that is laid
/// in double precision. The scale is a power of two, so scaling a scene by one changes no bit.
struct PatchArrays {
    std::uint32_t patch_count = 0;
    std::uint32_t stride = 0;           ///< patches, padded to whole blocks of kReduceBlock
    std::uint32_t corner_count = 4;     ///< 3 where the scene has triangles only
    std::vector<std::int32_t> corners;  ///< [corner][axis][stride], steps of kGridStep
    std::vector<float> normals;         ///< [axis][stride], unit; 0 beyond the last patch
    std::vector<std::int32_t> planes;   ///< [stride] Surface::plane; -1: no other patch's
    std::vector<std::int32_t> rooms;    ///< [stride] Rooms::before
    std::vector<std::int32_t> reached;  ///< [stride] Rooms::reached; of shooters, of all patches
    std::vector<std::uint8_t> rims;     ///< [stride] find_rims(); of shooters none
    glm::dvec3 centre{};
    double scale = 1;  ///< normalised = (world - centre) * scale; steps = normalised / kGridStep
};

/// What shoots, where patches do so in groups (Mesh::shooters): on the patches' grid.
struct ShooterArrays {
    PatchArrays polygons;
    std::vector<std::int32_t> first_patch;  ///< [polygons.stride + 1]; consecutive, the rest empty
};

/// The power of two that brings a mesh's coordinates to about 1: no bit of a result changes where a
/// scene is scaled by one, and squares are neither too large nor too small for floats.
double unit_scale(const Mesh& mesh);

/// Boxes and cones of consecutive patches, in the order of theirs; of normalised coordinates, large
/// enough for what their own rounding does.
std::vector<device::Cluster> clusters_of(const PatchArrays& arrays);

/// Corners a polygon on the device: 3 where there are only triangles, else 4.
std::uint32_t corner_count_of(const Mesh& mesh);

/// Without rims, which only analytic factors look at, all are 0. Throws InputError where the
/// scene's extent cannot be normalised.
PatchArrays patch_arrays(const Mesh& mesh, bool with_rims = true);

/// Empty where every patch shoots for itself.
ShooterArrays shooter_arrays(const Mesh& mesh, const PatchArrays& patches);

}  // namespace hemirad
