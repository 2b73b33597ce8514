// What each kernel of a shot makes of the machine: its seconds, the bytes and the arithmetic that
// its task needs, and what share that is of the speed of a streaming copy and of multiply-adds,
// measured on the spot. `bench_kernels ROOM.obj`; every input polygon is a patch.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "ceilings.h"
#include "scene/mesh.h"
#include "scene/read_scene.h"
#include "solver/solver.h"

namespace hemirad {
namespace {

constexpr std::uint32_t kShooters = 32;  // spread evenly over the patches
constexpr int kRounds = 3;               // of timed shots, after one that warms up
constexpr double kSamplingError = 1e-3;  // as SolverSettings has it
constexpr double kLeastCopy = 65536;     // bytes; of fewer, the launch is all that is measured

// Of a shot, means over the shooters.
struct Work {
    bool analytic = false;
    double patches = 0, corners = 0, blocks = 0;  // patches: padded to whole blocks
    double projected = 0;                         // patches that survive culling
    double entries = 0, lists = 0;                // patches in lists; a list a tile and stack
    double near_pairs = 0;
    double proxels = 0;  // of all tiles
    double visited = 0;  // proxels of the areas that the array visits, of all patches
    double inside = 0;   // proxels inside an outline, of all patches: what has to be evaluated
};

struct Stage {
    std::vector<double> seconds;  // of each launch
    double items = 0;             // patches, lists, blocks or proxels that a launch goes through
    double bytes = 0, flops = 0;  // a launch; 0: not counted
    double visited = 0;           // proxels, project_patches
};

using Stages = std::map<std::string, Stage>;

// Bytes that a kernel's task cannot do without, each read or written once.
std::map<std::string, double> bytes_by_kernel(const Work& work) {
    const double index = 4, count = 4, ranges = sizeof(device::Rectangle);
    const double projection = sizeof(device::Projection) + ranges;
    const double patch = 12 * work.corners + 12;    // corners and normal
    const double factors = work.analytic ? 12 : 0;  // visible, unblocked, doubtful
    const double covered = work.analytic ? count : 0;
    const double received = 2 * 8, row = 4;  // received and rest are read and written
    const double unshot = 8 + 4;             // read and written; reflectance
    return {
        {"cull_patches", work.patches * (patch + index) + work.projected * index},
        {"set_up_projection", work.projected * (index + patch + projection)},
        {"count_areas", work.projected * ranges + work.lists * count},
        {"prefix_sum", work.lists * 2 * count},
        {"bin_areas", work.projected * ranges + work.lists * 2 * count + work.entries * index},
        {"project_patches", work.proxels * (4 + covered) + work.entries * (index + projection) +
                                work.projected * 2 * (count + covered)},
        {"estimate_form_factors",
         work.projected * (index + patch + 2 * (count + covered + factors))},
        {"correct_near_pairs", work.near_pairs * (index + 4 + 2 * factors)},
        {"add_up_factors", work.patches * 8 + work.blocks * 8},
        {"spread_residual", work.blocks * 8},
        {"update_radiosity",
         work.patches * (received + row + (work.analytic ? 2 * factors : count))},
        {"update_unshot",
         work.patches * (unshot + row) + work.blocks * (sizeof(device::BlockSummary) + 4)},
        {"choose_shooter", work.blocks * (sizeof(device::BlockSummary) + 4)},
    };
}

// An edge or a depth plane of a proxel: two multiply-adds (evaluate.clh).
double projection_flops(const Work& work) { return work.inside * (work.corners + 1) * 4; }

std::map<std::string, double> items_by_kernel(const Work& work) {
    return {{"cull_patches", work.patches},
            {"set_up_projection", work.projected},
            {"count_areas", work.projected},
            {"prefix_sum", work.lists},
            {"bin_areas", work.projected},
            {"project_patches", work.inside},
            {"estimate_form_factors", work.projected},
            {"correct_near_pairs", work.near_pairs},
            {"add_up_factors", work.patches},
            {"spread_residual", work.blocks},
            {"update_radiosity", work.patches},
            {"update_unshot", work.patches},
            {"choose_shooter", work.blocks}};
}

PipelineSettings settings_for(const Mesh& mesh, std::uint32_t resolution, FormFactorMode mode) {
    PipelineSettings settings;
    settings.resolution = resolution;
    settings.form_factor = mode;
    if (mode == FormFactorMode::analytic) settings.near_pairs = near_pairs(mesh, kSamplingError);
    return settings;
}

ShotPipeline pipeline_for(const PatchArrays& patches, const PipelineSettings& settings) {
    ShotPipeline pipeline(patches, even_light(patches), settings, mp1map::Device::open(""));
    pipeline.init_plane();
    return pipeline;
}

std::vector<std::uint32_t> shooters_of(const PatchArrays& patches) {
    const std::uint32_t count = std::min(kShooters, patches.patch_count);
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < count; ++i) result.push_back(i * (patches.patch_count / count));
    return result;
}

Work measure_work(const PatchArrays& patches, PipelineSettings settings) {
    settings.count_activity = true;
    ShotPipeline pipeline = pipeline_for(patches, settings);
    const mp1map::PeArray& array = pipeline.pe_array();
    const auto tiles = [&](std::uint32_t tile) {
        return static_cast<double>((settings.resolution + tile - 1) / tile);
    };
    const double tile_count = tiles(array.tile_width) * tiles(array.tile_height);
    Work work;
    work.analytic = settings.form_factor == FormFactorMode::analytic;
    work.patches = patches.stride;
    work.corners = patches.corner_count;
    work.blocks = work.patches / kReduceBlock;
    work.lists = tile_count * array.array_count * array.pe_count();
    work.proxels = tile_count * array.tile_width * array.tile_height;
    const auto shooters = shooters_of(patches);
    const double share = 1.0 / static_cast<double>(shooters.size());
    for (const std::uint32_t shooter : shooters) {
        project_shooter(pipeline, shooter);
        work.projected += share * static_cast<double>(pipeline.projections().size());
        work.entries += share * pipeline.shot().bin_entries;
        const Activity activity = pipeline.activity();
        work.visited += share * activity.visited_areas * array.area_width() * array.area_height();
        work.inside += share * activity.useful_proxels;
        const auto& begin = settings.near_pairs.begin;
        if (!begin.empty()) work.near_pairs += share * (begin[shooter + 1] - begin[shooter]);
    }
    return work;
}

Stages time_kernels(const PatchArrays& patches, PipelineSettings settings) {
    settings.timed = settings.apart = true;
    ShotPipeline pipeline = pipeline_for(patches, settings);
    const auto shooters = shooters_of(patches);
    Stages stages;
    for (int round = 0; round <= kRounds; ++round)
        for (const std::uint32_t shooter : shooters) {
            auto before = pipeline.acu().kernel_seconds();
            pipeline.set_shooter(shooter);
            shoot(pipeline);
            if (round == 0) continue;
            for (const auto& [kernel, cost] : pipeline.acu().kernel_seconds())
                if (kernel != "init_plane")
                    stages[kernel].seconds.push_back(cost.first - before[kernel].first);
        }
    return stages;
}

Stages measure(const Mesh& mesh, const PatchArrays& patches, std::uint32_t resolution,
               FormFactorMode mode) {
    const PipelineSettings settings = settings_for(mesh, resolution, mode);
    const Work work = measure_work(patches, settings);
    const auto bytes = bytes_by_kernel(work), items = items_by_kernel(work);
    Stages stages = time_kernels(patches, settings);
    for (auto& [kernel, stage] : stages) {
        if (bytes.contains(kernel)) stage.bytes = bytes.at(kernel);
        if (items.contains(kernel)) stage.items = items.at(kernel);
        if (kernel != "project_patches") continue;
        stage.visited = work.visited;
        stage.flops = projection_flops(work);
    }
    return stages;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void report(benchmark::State& state, const Stage& stage, Ceilings& ceilings) {
    std::size_t launch = 0;
    for (auto _ : state) state.SetIterationTime(stage.seconds[launch++]);
    const double seconds = median(stage.seconds);
    state.counters["median_us"] = 1e6 * seconds;
    if (stage.items > 0) state.counters["items/s"] = stage.items / seconds;
    if (stage.bytes >= kLeastCopy) {
        state.counters["bytes/s"] = stage.bytes / seconds;
        state.counters["of_copy"] =
            ceilings.copy_seconds(static_cast<std::uint64_t>(stage.bytes)) / seconds;
    }
    if (stage.flops > 0) {
        state.counters["visited/s"] = stage.visited / seconds;
        state.counters["flop/s"] = stage.flops / seconds;
        state.counters["of_multiply_adds"] = stage.flops / seconds / ceilings.flops();
    }
}

void register_benchmarks(const Mesh& mesh, const PatchArrays& patches, std::uint32_t resolution,
                         FormFactorMode mode, Ceilings& ceilings) {
    const char* const name = mode == FormFactorMode::count ? "count" : "analytic";
    const Stages stages = measure(mesh, patches, resolution, mode);
    for (const std::string& kernel : kernel_names(mode)) {
        if (!stages.contains(kernel)) continue;
        const Stage& stage = stages.at(kernel);
        benchmark::RegisterBenchmark(
            (std::string(name) + "/" + std::to_string(resolution) + "/" + kernel).c_str(),
            [stage, &ceilings](benchmark::State& state) { report(state, stage, ceilings); })
            ->Iterations(static_cast<benchmark::IterationCount>(stage.seconds.size()))
            ->UseManualTime()
            ->Unit(benchmark::kMicrosecond);
    }
}

}  // namespace
}  // namespace hemirad

int main(int argc, char** argv) {
    using namespace hemirad;
    benchmark::Initialize(&argc, argv);
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_kernels [--benchmark_...] ROOM.obj\n");
        return 1;
    }
    MeshSettings settings;
    settings.patch_size = std::numeric_limits<double>::infinity();
    const auto mesh = build_mesh(read_scene(argv[1]), settings);
    const auto patches = patch_arrays(mesh);
    Ceilings ceilings(mp1map::Device::open(""));
    constexpr std::uint64_t kBeyondCaches = std::uint64_t{1} << 30;
    std::fprintf(stderr, "%s: %u patches; copy %.1f GB/s, multiply-adds %.1f Gflop/s\n", argv[1],
                 patches.patch_count,
                 1e-9 * static_cast<double>(kBeyondCaches) / ceilings.copy_seconds(kBeyondCaches),
                 1e-9 * ceilings.flops());
    for (const std::uint32_t resolution : {256u, 1024u})
        for (const auto mode : {FormFactorMode::count, FormFactorMode::analytic})
            register_benchmarks(mesh, patches, resolution, mode, ceilings);
    benchmark::RunSpecifiedBenchmarks();
}
