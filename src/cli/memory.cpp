#include "cli/memory.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

#include "cli/gather_lightmaps.h"
#include "cli/text.h"
#include "errors.h"
#include "solver/bands.h"
#include "solver/gather.h"
#include "solver/patch_arrays.h"

namespace hemirad {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
// Measured with PoCL 3.1 and LLVM 15: of a process that has opened the device and has its kernels
// from the cache, and how much more where they are compiled; a gather has kernels of its own.
constexpr std::uint64_t kProgram = 88 * kMiB;
constexpr std::uint64_t kCompiler = 155 * kMiB, kGatherCompiler = 60 * kMiB;
// Measured at 191,304 to 2 million patches: vertices, patches, fragments and grids, after the mesh
// was made.
constexpr std::uint64_t kMeshBytes = 190;
// While the arrays of the device are made on the host: corners, normals, planes.
constexpr std::uint64_t kUploadBytes = 85;
// Buffers of 8 MiB and more are of huge pages, of which a touch takes all.
constexpr std::uint64_t kHugePage = 2 * kMiB;
// Beside the channels of a texel: its footprint, 32 bytes, chart by chart.
constexpr std::uint64_t kFootprintBytes = 8;
// A texel of a preview, besides the light it is made of.
constexpr std::uint64_t kPreviewBytes = 6;

std::uint64_t whole_pages(std::uint64_t bytes) {
    return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

std::uint64_t texels_of(const Atlas& atlas) { return std::uint64_t{atlas.width} * atlas.height; }

std::uint64_t texels_of_all(const ChartLayout& layout) {
    std::uint64_t sum = 0;
    for (const Atlas& atlas : layout.atlases) sum += texels_of(atlas);
    return sum;
}

std::uint64_t texels_of_largest(const ChartLayout& layout) {
    std::uint64_t most = 0;
    for (const Atlas& atlas : layout.atlases) most = std::max(most, texels_of(atlas));
    return most;
}

std::uint64_t channel_count(const Mesh& mesh, const SolveOptions& options) {
    const auto& layers = options.layers;
    const std::uint64_t of_light = std::uint64_t{layers.emission} + options.estimate_error;
    return gathered_bands(options, mesh) + mesh.bands.size() * of_light + 1 +
           3 * (std::uint64_t{layers.normal} + layers.position) + options.solver.count_shots;
}

std::uint32_t resolution_of(const SolveOptions& options) {
    return options.target_error ? accuracy_at(first_step(*options.target_error)).resolution
                                : options.solver.resolution;
}

/// Rows are taken as shooters come; a solve that converges comes to most of them.
MemoryParts on_device(const Mesh& mesh, const SolveOptions& options,
                      const mp1map::DeviceSummary& device) {
    const auto& solver = options.solver;
    const std::uint64_t patches = mesh.patches.size(), shooters = mesh.shooter_count();
    const std::uint32_t resolution = resolution_of(options);
    const auto salvo = usable_salvo(solver.salvo, shooters, patches, resolution);
    const auto with_rows = [&](std::uint64_t row_bytes) {
        return estimated_device_bytes(
            static_cast<std::uint32_t>(patches), static_cast<std::uint32_t>(shooters),
            corner_count_of(mesh), plan_bands(mesh, solver.parts).solved.size(), resolution,
            solver.form_factor, row_bytes, mp1map::fit_pe_array(device, solver.pe_array), salvo,
            solver.count_shots);
    };
    const std::uint64_t plain = with_rows(0);
    const std::uint64_t rows =
        with_rows(usable_row_bytes(solver.row_bytes, shooters, patches, device)) - plain;
    const std::uint64_t shots = std::min<std::uint64_t>(solver.max_shots, shooters);
    const std::uint64_t touched = std::min(rows, whole_pages(4 * patches * shots));
    return {{"patches and plane on the device", plain,
             "raise --patch-size, lower --resolution or --salvo"},
            {"rows of form factors", touched, "lower --row-memory"}};
}

std::uint64_t near_pair_bytes(const Mesh& mesh, const SolverSettings& solver) {
    return solver.form_factor == FormFactorMode::analytic ? 8 * mesh.patches.size() : 0;
}

MemoryParts at_all_times(const Mesh& mesh) {
    return {{"program and OpenCL", kProgram},
            {"mesh", kMeshBytes * mesh.patches.size(), "raise --patch-size"}};
}

/// Irradiance and radiosity of light and its parts, in double precision, of one or two solutions.
MemoryPart solutions(const Mesh& mesh, const SolveOptions& options) {
    const std::uint64_t values = 2 * gathered_bands(options, mesh) * mesh.patches.size();
    const bool twice = options.estimate_error || options.target_error;
    return {"solution", 8 * values * (twice ? 3 : 1), "raise --patch-size"};
}

MemoryParts joined(MemoryParts parts, const MemoryParts& more) {
    parts.insert(parts.end(), more.begin(), more.end());
    return parts;
}

MemoryParts while_solving(const Mesh& mesh, const SolveOptions& options,
                          const mp1map::DeviceSummary& device) {
    const MemoryPart solution = solutions(mesh, options);
    const std::uint64_t upload = kUploadBytes * mesh.patches.size();
    MemoryParts parts = at_all_times(mesh);
    parts.push_back({"arrays for the device, solution",
                     std::max(upload, solution.bytes) + near_pair_bytes(mesh, options.solver),
                     "raise --patch-size"});
    return device.is_cpu ? joined(parts, on_device(mesh, options, device)) : parts;
}

MemoryPart gathered_light(const Mesh& mesh, const ChartLayout& layout,
                          const SolveOptions& options) {
    const std::uint64_t bytes = 4 * (gathered_bands(options, mesh) + 1);
    return {"gathered light", bytes * texels_of_all(layout), "raise --texel-size"};
}

MemoryParts while_gathering(const Mesh& mesh, const ChartLayout& layout,
                            const SolveOptions& options, const mp1map::DeviceSummary& device) {
    MemoryParts parts = at_all_times(mesh);
    parts.push_back(solutions(mesh, options));
    if (!options.gather) return parts;
    parts.push_back(gathered_light(mesh, layout, options));
    if (device.is_cpu)
        parts.push_back(
            {"gather on the device",
             gather_bytes(mesh, gathered_bands(options, mesh), gather_settings(options), device),
             "raise --patch-size or lower --gather"});
    return parts;
}

MemoryParts while_writing(const Mesh& mesh, const ChartLayout& layout,
                          const SolveOptions& options) {
    const std::uint64_t channels = channel_count(mesh, options);
    // Of what comes on top there is one after another.
    const std::uint64_t more =
        std::max({kFootprintBytes, options.pixels == PixelType::half ? 2 * channels : 0,
                  options.preview ? kFootprintBytes + kPreviewBytes : 0});
    const std::uint64_t texel = 4 * channels + more;
    MemoryParts parts = at_all_times(mesh);
    parts.push_back(solutions(mesh, options));
    parts.push_back({"lightmap", texel * texels_of_largest(layout),
                     "raise --texel-size, lower --atlas-size or ask for fewer --layers"});
    if (options.gather) parts.push_back(gathered_light(mesh, layout, options));
    return parts;
}

/// The number behind `name` in a file of the kernel's, or at its beginning; `otherwise` where there
/// is none ("max").
std::uint64_t number_in(const std::string& file, const std::string& name, std::uint64_t otherwise) {
    std::ifstream in(file);
    for (std::string word; word != name && in >> word;) {
    }
    std::uint64_t number = 0;
    return in >> number ? number : otherwise;
}

std::uint64_t resident_bytes() {
    std::ifstream in("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    in >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::string shortage(const std::string& scene, std::uint64_t bytes, const std::string& than) {
    return scene + ": needs about " + bytes_text(bytes) + ", " + than;
}

/// Of what can be made smaller; where nothing helps, that.
std::string advice_on(const MemoryEstimate& estimate, std::uint64_t limit) {
    const MemoryParts& parts = estimate.parts;
    std::uint64_t least = estimate.compiler_bytes;
    for (const MemoryPart& part : parts)
        if (part.advice.empty()) least += part.bytes;
    if (least > limit)
        return "; no option gets below the " + bytes_text(least) +
               " of the program and its compiler";
    const auto by_advice = [](const MemoryPart& a, const MemoryPart& b) {
        return std::pair(!a.advice.empty(), a.bytes) < std::pair(!b.advice.empty(), b.bytes);
    };
    const MemoryPart& largest = *std::ranges::max_element(parts, by_advice);
    return "; " + bytes_text(largest.bytes) + " for " + largest.name + ": " + largest.advice;
}

}  // namespace

std::uint64_t total(const MemoryParts& parts) {
    std::uint64_t sum = 0;
    for (const MemoryPart& part : parts) sum += part.bytes;
    return sum;
}

MemoryEstimate estimate_memory(const Mesh& mesh, const ChartLayout& layout,
                               const SolveOptions& options, const mp1map::DeviceSummary& device) {
    MemoryEstimate estimate;
    estimate.device_bytes = total(on_device(mesh, options, device));
    if (options.gather)
        estimate.device_bytes = std::max(
            estimate.device_bytes,
            gather_bytes(mesh, gathered_bands(options, mesh), gather_settings(options), device));
    estimate.compiler_bytes = kCompiler + (options.gather ? kGatherCompiler : 0);
    for (auto& parts :
         {while_solving(mesh, options, device), while_gathering(mesh, layout, options, device),
          while_writing(mesh, layout, options)})
        if (total(parts) > estimate.bytes()) estimate.parts = parts;
    return estimate;
}

std::string memory_text(const MemoryEstimate& estimate) {
    std::string text;
    for (const MemoryPart& part : estimate.parts)
        if (part.bytes >= kMiB) {
            text += text.empty() ? ": " : ", ";
            text += part.name + " " + bytes_text(part.bytes);
        }
    return "about " + bytes_text(estimate.bytes()) + text + "; where kernels are compiled, " +
           bytes_text(estimate.compiler_bytes) + " more";
}

std::uint64_t available_memory() {
    constexpr auto kUnknown = std::numeric_limits<std::uint64_t>::max() / 4;
    const std::uint64_t own = resident_bytes();
    const std::uint64_t kib = number_in("/proc/meminfo", "MemAvailable:", kUnknown >> 10);
    const std::uint64_t swap = number_in("/proc/meminfo", "SwapFree:", 0);
    const std::string group = "/sys/fs/cgroup/memory.";
    const std::uint64_t most = number_in(group + "max", "", kUnknown);
    const std::uint64_t used = number_in(group + "current", "", 0);
    return std::min((kib + swap) * 1024, most - std::min(most, used)) + own;
}

void require_memory(const std::string& scene, const MemoryEstimate& estimate,
                    const SolveOptions& options, const mp1map::DeviceSummary& device) {
    const std::uint64_t needed = estimate.bytes() + estimate.compiler_bytes;
    const std::uint64_t limit = options.memory_limit.value_or(available_memory());
    if (needed > limit)
        throw InputError(shortage(scene, needed,
                                  options.memory_limit ? "--memory-limit is " + bytes_text(limit)
                                                       : bytes_text(limit) + " are free") +
                         advice_on(estimate, limit));
    if (estimate.device_bytes > device.global_memory)
        throw InputError(shortage(scene, estimate.device_bytes,
                                  device.name + " has " + bytes_text(device.global_memory)) +
                         "; raise --patch-size or lower --resolution" +
                         (options.gather ? " or --gather" : ""));
}

}  // namespace hemirad
