#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/solve_options.h"
#include "lightmap/chart_layout.h"
#include "mp1map/device.h"
#include "scene/mesh.h"

namespace hemirad {

/// What takes memory, and the options that make it less.
struct MemoryPart {
    std::string name;
    std::uint64_t bytes = 0;
    std::string advice = {};
};

/// What is held at the same time.
using MemoryParts = std::vector<MemoryPart>;

std::uint64_t total(const MemoryParts& parts);

/// The memory of a whole process at its peak, host and, where that is a CPU, device.
struct MemoryEstimate {
    MemoryParts parts;                 ///< of the moment when most is held
    std::uint64_t compiler_bytes = 0;  ///< more, where kernels are not in PoCL's cache
    std::uint64_t device_bytes = 0;    ///< of the parts, or beside them where it is no CPU

    std::uint64_t bytes() const { return total(parts); }
};

/// One line: "about " the sum, then the parts.
std::string memory_text(const MemoryEstimate& estimate);

/// Of a solve that shoots until it has converged, or for max_shots; reading and meshing have taken
/// `prepare_bytes`.
MemoryEstimate estimate_memory(const Mesh& mesh, const ChartLayout& layout,
                               const SolveOptions& options, const mp1map::DeviceSummary& device,
                               std::uint64_t prepare_bytes);

/// Of this process so far, host and, where that is a CPU, device.
std::uint64_t peak_memory_bytes();

/// free_memory(), and what this process has already.
std::uint64_t available_memory();

/// Before the mesh is made, which may take all there is: throws InputError where its patches alone,
/// with their arrays for a device, need more than the limit, or, without one, than is free. What
/// build_mesh() refuses is left to it.
void require_memory_for_mesh(const Scene& scene, const MeshSettings& settings,
                             std::optional<std::uint64_t> limit, const std::string& device);

/// Throws InputError where a solve needs more than the limit, or more of the device than it has,
/// with the numbers, the largest part and how to make it smaller.
void require_memory(const std::string& scene, const MemoryEstimate& estimate,
                    const SolveOptions& options, const mp1map::DeviceSummary& device);

}  // namespace hemirad
