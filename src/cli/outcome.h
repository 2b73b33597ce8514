#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/gather_lightmaps.h"
#include "cli/memory.h"
#include "lightmap/atlas_contents.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "solver/accuracy.h"
#include "solver/solution.h"
#include "solver/solver.h"

namespace hemirad {

/// An atlas as it was written.
struct LightmapFile {
    std::filesystem::path file;
    AtlasContents contents;
    std::size_t covered_texels = 0;  ///< that a surface reaches into
};

/// What a solve came to, for the summary and the report.
struct Outcome {
    struct Seconds {
        double total = 0, build_kernels = 0, solve = 0, gather = 0, lightmap = 0;
        double per_shot_median = 0;
        double prepare = 0;  ///< scene, mesh and charts, before there is a device
        std::map<std::string, std::pair<double, std::uint64_t>> per_kernel;  ///< and launches
    };

    /// What a second solution says of the error.
    struct Error {
        double relative_rms = 0;  ///< of the patches' irradiance, see relative_rms_difference
        double largest = 0;       ///< of a patch, W/m^2
        Accuracy against;         ///< settings of the second solution
        Solution by_patch;        ///< |difference| as irradiance and radiosity
    };

    Stop stop = Stop::converged;
    Solution solution;
    Accuracy accuracy;  ///< that it was solved with
    std::optional<Error> error;
    Closure closure;
    std::optional<GatheredLightmaps> gathered;
    std::uint64_t repeated_shots = 0;
    std::uint64_t resumed_shots = 0;  ///< of all, those before --resume
    std::optional<std::string> checkpoint_fault;
    Seconds seconds;
    mp1map::DeviceSummary device;
    mp1map::PeArray pe_array;
    std::uint64_t device_bytes = 0;
    MemoryEstimate memory;             ///< as told before the work began
    std::optional<Forecast> forecast;  ///< as told before the first shot
    std::vector<LightmapFile> lightmaps;
    std::vector<std::filesystem::path> outputs;
    std::vector<std::string> warnings;
};

}  // namespace hemirad
