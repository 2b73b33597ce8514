#include "cli/memory.h"

#include <algorithm>

#include "solver/bands.h"

namespace hemirad {

std::uint64_t device_bytes(const Mesh& mesh, std::uint32_t resolution,
                           const SolverSettings& settings, const mp1map::DeviceSummary& device) {
    const std::uint64_t patches = mesh.patches.size(), shooters = mesh.shooter_count();
    const bool triangles_only = std::all_of(mesh.patches.begin(), mesh.patches.end(),
                                            [](const Patch& patch) { return patch.is_triangle(); });
    return estimated_device_bytes(
        static_cast<std::uint32_t>(patches), static_cast<std::uint32_t>(shooters),
        triangles_only ? 3 : 4, plan_bands(mesh, settings.parts).solved.size(), resolution,
        settings.form_factor, usable_row_bytes(settings.row_bytes, shooters, patches, device),
        mp1map::fit_pe_array(device, settings.pe_array),
        usable_salvo(settings.salvo, shooters, patches, resolution));
}

}  // namespace hemirad
