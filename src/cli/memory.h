#pragma once

#include <cstddef>
#include <cstdint>

#include "mp1map/pe_array.h"
#include "scene/mesh.h"
#include "solver/shot_pipeline.h"

namespace hemirad {

/// Bytes that solving so many bands of a mesh will hold on the device.
std::uint64_t device_bytes(const Mesh& mesh, std::size_t bands, std::uint32_t resolution,
                           FormFactorMode mode, std::uint64_t row_bytes,
                           const mp1map::PeArray& array);

}  // namespace hemirad
