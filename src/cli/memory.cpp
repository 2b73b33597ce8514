#include "cli/memory.h"

#include <algorithm>

#include "solver/shot_pipeline.h"

namespace hemirad {

std::uint64_t device_bytes(const Mesh& mesh, std::size_t bands, std::uint32_t resolution,
                           FormFactorMode mode, std::uint64_t row_bytes,
                           const mp1map::PeArray& array) {
    const bool triangles_only = std::all_of(mesh.patches.begin(), mesh.patches.end(),
                                            [](const Patch& patch) { return patch.is_triangle(); });
    return estimated_device_bytes(static_cast<std::uint32_t>(mesh.patches.size()),
                                  static_cast<std::uint32_t>(mesh.shooter_count()),
                                  triangles_only ? 3 : 4, bands, resolution, mode, row_bytes,
                                  array);
}

}  // namespace hemirad
