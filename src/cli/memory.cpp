#include "cli/memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <fstream>
#include <set>
#include <utility>

#include "cli/free_memory.h"
#include "cli/gather_lightmaps.h"
#include "cli/seen_share.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/footprint.h"
#include "scene/surface_point.h"
#include "solver/bands.h"
#include "solver/gather.h"
#include "solver/near_pairs.h"
#include "solver/patch_arrays.h"

namespace hemirad {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
// Measured with PoCL 3.1 and LLVM 15: of a process that has opened the device and has its kernels
// from the cache, and how much more where they are compiled; a gather has kernels of its own.
constexpr std::uint64_t kProgram = 88 * kMiB;
constexpr std::uint64_t kCompiler = 155 * kMiB, kGatherCompiler = 60 * kMiB;
constexpr std::uint64_t kGatherKernels = 8 * kMiB;
// Measured at 191,304 to 2 million patches: vertices, patches, fragments and grids, after the mesh
// was made.
constexpr std::uint64_t kMeshBytes = 190;  // and 185 to 203 at the most while it is made
// While the arrays of the device are made on the host: corners, normals, planes.
constexpr std::uint64_t kUploadBytes = 85;
// Buffers of 8 MiB and more are of huge pages, of which a touch takes all.
constexpr std::uint64_t kHugePage = 2 * kMiB;
// A texel of the part of an atlas that is drawn.
constexpr std::uint64_t kFootprintBytes = sizeof(Footprint);
// What charts are gathered together, src/lightmap/gather_light.cpp.
constexpr std::uint64_t kTexelsTogether = 1u << 22;
// Of texels shown, those asked for in the largest round, and a round's cells of each: measured on
// scenes where 28 to 86 % are gathered in all.
constexpr double kLargestRound = 0.25;
constexpr std::uint64_t kCellBytes = 24;
// Beside the channels, chart by chart or in the encoder.
constexpr std::uint64_t kLeastMore = 8;
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

/// Of the largest part of an atlas that is drawn at once: a chart, or all of an atlas that holds
/// the scene's own.
std::uint64_t texels_of_largest_part(const ChartLayout& layout) {
    std::uint64_t most = 0;
    for (const Chart& chart : layout.charts)
        most = std::max(most, std::uint64_t{chart.width + 2 * layout.padding} *
                                  (chart.height + 2 * layout.padding));
    for (const AuthoredTriangle& triangle : layout.authored)
        most = std::max(most, texels_of(layout.atlases[triangle.atlas]));
    return most;
}

/// With the queue by which what is hidden is filled, which doubles as it grows.
std::uint64_t footprint_bytes(const ChartLayout& layout) {
    const std::uint64_t texels = texels_of_largest_part(layout);
    return kFootprintBytes * texels + sizeof(std::size_t) * std::bit_ceil(texels);
}

std::uint64_t channel_count(const Mesh& mesh, const SolveOptions& options) {
    const auto& layers = options.layers;
    const std::uint64_t of_light = std::uint64_t{layers.emission} + options.estimate_error;
    return gathered_bands(options, mesh) + mesh.bands.size() * of_light + 1 +
           3 * (std::uint64_t{layers.normal} + layers.position) + options.solver.count_shots;
}

/// What a target leaves open is as in the first solve that is compared with another one.
SolveOptions with_accuracy(SolveOptions options) {
    if (options.target_error)
        set_accuracy(options.solver, accuracy_at(first_step(*options.target_error)));
    return options;
}

/// What is touched of the memory for rows: they are made as shooters come, and a solve that
/// converges comes to most of them; those that look ahead have theirs too. Where
/// there is certainly not room for all, nobody asks what they see, nor of a mesh that takes long.
std::uint64_t touched_row_bytes(const Mesh& mesh, const SolveOptions& options, std::uint32_t salvo,
                                std::uint64_t allocated) {
    constexpr double kLeastSeen = 0.05;
    constexpr std::uint64_t kManyPatches = 200'000;
    const std::uint64_t patches = mesh.patches.size(), shooters = mesh.shooter_count();
    const std::uint64_t shots = std::min<std::uint64_t>(options.solver.max_shots, shooters);
    const std::uint64_t rows = std::min(shooters, shots * salvo);
    const auto bytes = [&](double share) {
        return rows * estimated_row_bytes(share * static_cast<double>(patches), patches);
    };
    if (bytes(kLeastSeen) >= allocated) return allocated;
    if (patches > kManyPatches) return std::min(allocated, whole_pages(bytes(1)));
    return std::min(allocated, whole_pages(bytes(seen_share(mesh))));
}

MemoryParts on_device(const Mesh& mesh, const SolveOptions& options,
                      const mp1map::DeviceSummary& device) {
    const auto& solver = options.solver;
    const std::uint64_t patches = mesh.patches.size(), shooters = mesh.shooter_count();
    const auto salvo = usable_salvo(solver.salvo, shooters, patches, solver.resolution);
    const auto with_rows = [&](std::uint64_t row_bytes) {
        return estimated_device_bytes(
            static_cast<std::uint32_t>(patches), static_cast<std::uint32_t>(shooters),
            corner_count_of(mesh), plan_bands(mesh, solver.parts).solved.size(), solver.resolution,
            solver.form_factor, row_bytes, mp1map::fit_pe_array(device, solver.pe_array), salvo,
            solver.count_shots);
    };
    const std::uint64_t plain = with_rows(0);
    const std::uint64_t rows =
        with_rows(usable_row_bytes(solver.row_bytes, shooters, patches, device)) - plain;
    return {{"patches and plane on the device", plain,
             "raise --patch-size, lower --resolution or --salvo"},
            {"rows of form factors",
             device.is_cpu ? touched_row_bytes(mesh, options, salvo, rows) : rows,
             "lower --row-memory"}};
}

std::uint64_t near_finds(const Mesh& mesh, const SolverSettings& solver) {
    return solver.form_factor == FormFactorMode::analytic
               ? estimated_near_finds(mesh, solver.sampling_error)
               : 0;
}

constexpr const char* kNearPairsAdvice = "raise --sampling-error or --patch-size";

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

MemoryParts while_pairing(const Mesh& mesh, std::uint64_t finds) {
    return joined(at_all_times(mesh),
                  {{"pairs of near patches", near_pairs_bytes(mesh, finds), kNearPairsAdvice}});
}

MemoryParts while_solving(const Mesh& mesh, const SolveOptions& options, bool is_cpu,
                          const MemoryParts& on_device, std::uint64_t finds) {
    const MemoryPart solution = solutions(mesh, options);
    const std::uint64_t upload = kUploadBytes * mesh.patches.size();
    // A patch and a factor, on the host and, where that is the same memory, on the device.
    const std::uint64_t near = 8 * finds * (is_cpu ? 2 : 1);
    MemoryParts parts = at_all_times(mesh);
    parts.push_back({"arrays for the device, solution", std::max(upload, solution.bytes),
                     "raise --patch-size"});
    parts.push_back({"pairs of near patches", near, kNearPairsAdvice});
    return is_cpu ? joined(parts, on_device) : parts;
}

MemoryPart gathered_light(const Mesh& mesh, const ChartLayout& layout,
                          const SolveOptions& options) {
    const std::uint64_t bytes = 4 * (gathered_bands(options, mesh) + 1);
    return {"gathered light", bytes * texels_of_all(layout), "raise --texel-size"};
}

/// Of charts with their gutters, and without.
struct Texels {
    std::uint64_t all = 0, shown = 0;

    bool operator<(const Texels& other) const { return all < other.all; }
};

/// Of the charts of an atlas that are gathered together, where these have the most.
Texels texels_gathered_together(const ChartLayout& layout) {
    std::vector<Texels> of_atlas(layout.atlases.size());
    Texels most;
    const auto add = [&](std::uint32_t atlas, const Texels& more) {
        Texels& together = of_atlas[atlas];
        together = {together.all + more.all, together.shown + more.shown};
        most = std::max(most, together);
        if (together.all >= kTexelsTogether) together = {};
    };
    std::set<std::uint32_t> authored;
    for (const AuthoredTriangle& triangle : layout.authored) authored.insert(triangle.atlas);
    for (const std::uint32_t atlas : authored)
        add(atlas, {texels_of(layout.atlases[atlas]), texels_of(layout.atlases[atlas])});
    const std::uint64_t gutter = 2 * layout.padding;
    for (const Chart& chart : layout.charts)
        add(chart.atlas, {(chart.width + gutter) * (chart.height + gutter),
                          std::uint64_t{chart.width} * chart.height});
    return most;
}

/// The lightmap of the patches as a guide, footprints and values of the charts gathered together,
/// the footprints of the chart that is drawn, and what is asked for in a round: points, which
/// texels they are, what is found there.
MemoryPart texels_to_gather(const Mesh& mesh, const ChartLayout& layout,
                            const SolveOptions& options) {
    const std::uint64_t bands = gathered_bands(options, mesh);
    const Texels texels = texels_gathered_together(layout);
    const std::uint64_t texel = kFootprintBytes + 4 * bands + 5;  // state and patch beyond
    const std::uint64_t point = sizeof(SurfacePoint) + 4 + 8 * bands;
    const std::uint64_t asked =
        options.gather_error > 0
            ? static_cast<std::uint64_t>(kLargestRound * double(texels.shown)) *
                  (point + kCellBytes)
            : texels.shown * point;
    return {"texels to gather",
            4 * (bands + 1) * texels_of_largest(layout) + texel * texels.all +
                footprint_bytes(layout) + asked,
            "raise --texel-size or --gather-error"};
}

/// Beside the buffers: its kernels, and what patches send, once more.
MemoryPart gather_on_host(const Mesh& mesh, const SolveOptions& options) {
    const std::uint64_t patch = kUploadBytes + 2 * 8 * gathered_bands(options, mesh);
    return {"kernels and patches of the gather", kGatherKernels + patch * mesh.patches.size(),
            "raise --patch-size"};
}

MemoryParts while_gathering(const Mesh& mesh, const ChartLayout& layout,
                            const SolveOptions& options, const mp1map::DeviceSummary& device) {
    MemoryParts parts = at_all_times(mesh);
    parts.push_back(solutions(mesh, options));
    if (!options.gather) return parts;
    parts.push_back(gathered_light(mesh, layout, options));
    parts.push_back(texels_to_gather(mesh, layout, options));
    parts.push_back(gather_on_host(mesh, options));
    if (device.is_cpu)
        parts.push_back(
            {"gather on the device",
             gather_bytes(mesh, gathered_bands(options, mesh), gather_settings(options), device),
             "raise --patch-size or lower --gather"});
    return parts;
}

MemoryPart lightmap(const Mesh& mesh, const ChartLayout& layout, const SolveOptions& options) {
    const std::uint64_t channels = channel_count(mesh, options), texels = texels_of_largest(layout);
    // Of what comes on top there is one after another.
    const std::uint64_t more =
        std::max({kLeastMore, options.pixels == PixelType::half ? 2 * channels : 0,
                  options.preview ? kLeastMore + kPreviewBytes : 0});
    return {"lightmap", 4 * channels * texels + std::max(more * texels, footprint_bytes(layout)),
            "raise --texel-size, lower --atlas-size or ask for fewer --layers"};
}

MemoryParts while_writing(const Mesh& mesh, const ChartLayout& layout,
                          const SolveOptions& options) {
    MemoryParts parts = at_all_times(mesh);
    parts.push_back(solutions(mesh, options));
    parts.push_back(lightmap(mesh, layout, options));
    if (options.gather) parts.push_back(gathered_light(mesh, layout, options));
    return parts;
}

/// Interim pictures are made beside the solver.
MemoryParts while_solving_and_writing(const Mesh& mesh, const ChartLayout& layout,
                                      const SolveOptions& options, bool is_cpu,
                                      const MemoryParts& on_device, std::uint64_t finds) {
    MemoryParts parts = while_solving(mesh, options, is_cpu, on_device, finds);
    if (options.snapshots.shots > 0 || options.snapshots.seconds > 0)
        parts.push_back(lightmap(mesh, layout, options));
    return parts;
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

/// The arrays of a device, where that is a CPU. It is asked for, which takes half a second, where a
/// mesh takes longer.
std::uint64_t least_on_cpu(std::uint32_t patches, const std::string& name) {
    constexpr std::uint32_t kMany = 1'000'000;
    if (patches < kMany || mp1map::list_devices().empty()) return 0;
    const auto device = mp1map::Device::open(name).summary();
    if (!device.is_cpu) return 0;
    return estimated_device_bytes(patches, 1, 3, 1, 16, FormFactorMode::count, 0,
                                  mp1map::fit_pe_array(device, {}), 1, false);
}

/// Of what is told to need more than `limit`, or than is free.
void require_free(const std::string& scene, const MemoryEstimate& estimate,
                  std::optional<std::uint64_t> limit) {
    const std::uint64_t needed = estimate.bytes() + estimate.compiler_bytes;
    const std::uint64_t most = limit.value_or(available_memory());
    if (needed <= most) return;
    throw InputError(
        shortage(scene, needed,
                 limit ? "--memory-limit is " + bytes_text(most) : bytes_text(most) + " are free") +
        advice_on(estimate, most));
}

}  // namespace

std::uint64_t total(const MemoryParts& parts) {
    std::uint64_t sum = 0;
    for (const MemoryPart& part : parts) sum += part.bytes;
    return sum;
}

MemoryEstimate estimate_memory(const Mesh& mesh, const ChartLayout& layout,
                               const SolveOptions& asked, const mp1map::DeviceSummary& device,
                               std::uint64_t prepare_bytes) {
    const SolveOptions options = with_accuracy(asked);
    MemoryEstimate estimate;
    const MemoryParts read = {{"reading the scene and making its mesh", prepare_bytes,
                               "raise --patch-size, or make the scene or its textures smaller"}};
    const MemoryParts solving = on_device(mesh, options, device);
    estimate.device_bytes = total(solving);
    if (options.gather)
        estimate.device_bytes = std::max(
            estimate.device_bytes,
            gather_bytes(mesh, gathered_bands(options, mesh), gather_settings(options), device));
    estimate.compiler_bytes = kCompiler + (options.gather ? kGatherCompiler : 0);
    const std::uint64_t finds = near_finds(mesh, options.solver);
    for (auto& parts :
         {read, while_pairing(mesh, finds),
          while_solving_and_writing(mesh, layout, options, device.is_cpu, solving, finds),
          while_gathering(mesh, layout, options, device), while_writing(mesh, layout, options)})
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

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::uint64_t available_memory() { return free_memory() + resident_bytes(); }

void require_memory_for_mesh(const Scene& scene, const MeshSettings& settings,
                             std::optional<std::uint64_t> limit, const std::string& device) {
    const double least = least_patches(scene, settings);
    if (!(least < kMostMeshPatches)) return;
    const auto patches = static_cast<std::uint32_t>(least);
    const bool has_elements =
        settings.element_size > 0 && settings.element_size < settings.patch_size;
    MemoryEstimate estimate;
    estimate.parts = {{counted(patches, "patch", "patches"),
                       patches * (kMeshBytes + kUploadBytes) + least_on_cpu(patches, device),
                       has_elements ? "raise --element-size" : "raise --patch-size"}};
    require_free(scene.file, estimate, limit);
}

void require_memory(const std::string& scene, const MemoryEstimate& estimate,
                    const SolveOptions& options, const mp1map::DeviceSummary& device) {
    require_free(scene, estimate, options.memory_limit);
    if (estimate.device_bytes > device.global_memory)
        throw InputError(shortage(scene, estimate.device_bytes,
                                  device.name + " has " + bytes_text(device.global_memory)) +
                         "; raise --patch-size or lower --resolution" +
                         (options.gather ? " or --gather" : ""));
}

}  // namespace hemirad
