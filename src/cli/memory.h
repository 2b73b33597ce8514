#pragma once

#include <cstdint>
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

/// Of a solve that shoots until it has converged, or for max_shots.
MemoryEstimate estimate_memory(const Mesh& mesh, const ChartLayout& layout,
                               const SolveOptions& options, const mp1map::DeviceSummary& device);

/// Of this process so far, host and, where that is a CPU, device.
std::uint64_t peak_memory_bytes();

/// What processes may still take of the machine or, where that is less, of their control group,
/// and what this one has already; the largest number there is where neither can be told.
std::uint64_t available_memory();

/// Throws InputError where a solve needs more than the limit, or more of the device than it has,
/// with the numbers, the largest part and how to make it smaller.
void require_memory(const std::string& scene, const MemoryEstimate& estimate,
                    const SolveOptions& options, const mp1map::DeviceSummary& device);

}  // namespace hemirad
