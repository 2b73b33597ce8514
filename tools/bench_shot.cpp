// One shot of progressive radiosity in a furnished room, per plane resolution: the whole shot, and
// the share of each kernel as counters. `bench_shot ROOM.obj`; every input polygon is a patch.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <limits>
#include <memory>

#include "scene/mesh.h"
#include "scene/read_scene.h"
#include "solver/solver.h"

namespace hemirad {
namespace {

constexpr std::uint32_t kShooters = 64;  // spread evenly over the patches

ShotPipeline pipeline_for(const PatchArrays& patches, PipelineSettings settings, bool timed) {
    settings.timed = timed;
    ShotPipeline pipeline(patches, even_light(patches), settings, mp1map::Device::open(""));
    pipeline.init_plane();
    return pipeline;
}

device::Shot shoot_from(ShotPipeline& pipeline, std::uint32_t patch) {
    pipeline.set_shooter(patch);
    shoot(pipeline);
    return pipeline.shot();
}

void run_shots(benchmark::State& state, const PatchArrays& patches, FormFactorMode form_factor) {
    const auto resolution = static_cast<std::uint32_t>(state.range(0));
    PipelineSettings settings;
    settings.resolution = resolution;
    settings.form_factor = form_factor;
    ShotPipeline pipeline = pipeline_for(patches, settings, false);
    std::uint32_t shooter = 0;
    const auto next = [&] { return shooter++ % kShooters * (patches.patch_count / kShooters); };
    for (int warm_up = 0; warm_up < 8; ++warm_up) shoot_from(pipeline, next());
    for (auto _ : state) benchmark::DoNotOptimize(shoot_from(pipeline, next()));

    ShotPipeline timed = pipeline_for(patches, settings, true);
    for (std::uint32_t i = 0; i < kShooters; ++i) shoot_from(timed, next());
    for (const auto& [name, cost] : timed.acu().kernel_seconds())
        if (name != "init_plane") state.counters[name + "_ms"] = 1e3 * cost.first / kShooters;
    state.counters["bytes_per_patch"] =
        static_cast<double>(pipeline.device_bytes() - 4 * resolution * resolution) /
        patches.patch_count;
    state.counters["proxels/s"] = benchmark::Counter(static_cast<double>(pipeline.disk_proxels()),
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace
}  // namespace hemirad

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (argc != 2) {
        std::fprintf(stderr, "usage: bench_shot [--benchmark_...] ROOM.obj\n");
        return 1;
    }
    hemirad::MeshSettings settings;
    settings.patch_size = std::numeric_limits<double>::infinity();
    const auto mesh = hemirad::build_mesh(hemirad::read_scene(argv[1]), settings);
    const auto patches = hemirad::patch_arrays(mesh);
    std::fprintf(stderr, "%s: %u patches\n", argv[1], patches.patch_count);
    for (const auto& [name, mode] : {std::pair{"count", hemirad::FormFactorMode::count},
                                     std::pair{"analytic", hemirad::FormFactorMode::analytic}})
        benchmark::RegisterBenchmark(name,
                                     [&patches, form_factor = mode](benchmark::State& state) {
                                         hemirad::run_shots(state, patches, form_factor);
                                     })
            ->RangeMultiplier(2)
            ->Range(128, 2048)
            ->UseRealTime()
            ->Unit(benchmark::kMillisecond);
    benchmark::RunSpecifiedBenchmarks();
}
