#pragma once

#include <vector>

#include "scene/mesh.h"
#include "solver/bands.h"
#include "solver/solution.h"

namespace hemirad {

/// What the device holds of the solved bands, as parts of what each emits.
struct DeviceLight {
    std::uint32_t patch_stride = 0, shooter_stride = 0;
    std::vector<double> received;  ///< [solved * patch_stride + patch]
    std::vector<float> unshot;     ///< [solved * shooter_stride + shooter]
    std::vector<double> escaped;   ///< [solved]
};

/// Irradiance, radiosity and ledgers of the scene's bands, and of the parts that were planned; how
/// far the solve has come is left to the caller.
Solution assemble_solution(const Mesh& mesh, const BandPlan& plan, const DeviceLight& light);

}  // namespace hemirad
