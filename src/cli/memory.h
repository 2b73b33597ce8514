#pragma once

#include <cstddef>
#include <cstdint>

#include "mp1map/pe_array.h"
#include "scene/mesh.h"
#include "solver/solver.h"

namespace hemirad {

/// Bytes that solving a mesh will hold on the device. Of the settings' resolution nothing is read.
std::uint64_t device_bytes(const Mesh& mesh, std::uint32_t resolution,
                           const SolverSettings& settings, const mp1map::DeviceSummary& device);

}  // namespace hemirad
