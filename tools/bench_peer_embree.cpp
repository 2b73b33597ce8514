// Shots of progressive radiosity against a ray caster that follows the same directions: for each
// resolution, the whole shots of a few shooters, sent off one behind another as in a solve, and
// Embree's packets for the same, all their tiles in one pool, take turns. Fails where what they
// count differs. `bench_peer_embree ROOM.obj`; every input polygon is a patch.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "errors.h"
#include "packet_caster.h"
#include "scene/mesh.h"
#include "scene/read_scene.h"
#include "solver/solver.h"

namespace hemirad {
namespace {

// Counts differ where a ray meets an edge; more than this share of the disk is a fault.
constexpr double kMostDisagreement = 0.01;

struct Options {
    std::string scene;
    std::vector<std::uint32_t> resolutions = {256, 512, 1024, 2048};
    std::uint32_t shooters = 64;
    std::uint32_t rounds = 5;
    std::string csv;
};

constexpr std::size_t kShotsPerTurn = 8;

struct Comparison {
    std::uint32_t resolution = 0;
    std::size_t shooters = 0;
    double embree_ms = 0, hemirad_ms = 0;                 // a shot; medians of turns
    double ratio = 0, processor_ratio = 0;                // medians of Embree's time over ours
    double mean_disagreement = 0, most_disagreement = 0;  // of the disk's proxels
};

// Wall time, and what all threads spent on processors, which others' work delays less.
struct Duration {
    double wall_ms, processor_ms;
};

template <class Work>
Duration time_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t before = std::clock();
    work();
    const std::clock_t after = std::clock();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    return {wall.count(), 1e3 * static_cast<double>(after - before) / CLOCKS_PER_SEC};
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

ShotPipeline pipeline_for(const PatchArrays& patches, std::uint32_t resolution) {
    PipelineSettings settings;
    settings.resolution = resolution;
    ShotPipeline pipeline(patches, even_light(patches), settings, mp1map::Device::open(""));
    pipeline.init_plane();
    return pipeline;
}

struct Aimed {
    std::uint32_t patch;
    device::Shot shot;    // origin and axes
    double disagreement;  // of the disk's proxels
};

// Whether the hemisphere's origin lies behind the patch.
bool sees_back_of(const PatchArrays& patches, std::size_t patch, const device::Shot& aimed) {
    double height = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        height += double{patches.normals[axis * patches.stride + patch]} *
                  (double(aimed.origin[axis]) - patches.corners[axis * patches.stride + patch]);
    return height < 0;
}

// Within a solid our shots go on through its faces' backs; the rays end there.
bool is_within_solid(const PatchArrays& patches, std::span<const std::int32_t> counts,
                     const device::Shot& aimed) {
    std::int64_t backs = 0, all = 0;
    for (std::size_t patch = 0; patch < counts.size(); ++patch) {
        all += counts[patch];
        if (counts[patch] != 0 && sees_back_of(patches, patch, aimed)) backs += counts[patch];
    }
    return 2 * backs > all;
}

double disagreement(std::span<const std::int32_t> ours, std::span<const std::int32_t> theirs,
                    std::uint64_t disk_proxels) {
    std::int64_t difference = 0;
    for (std::size_t patch = 0; patch < theirs.size(); ++patch)
        difference += std::abs(ours[patch] - theirs[patch]);
    return static_cast<double>(difference) / static_cast<double>(disk_proxels);
}

// Shooters spread evenly over the patches but for those within solids. On its way makes room for
// the lists of tiles, and warms both up.
std::vector<Aimed> aim(const PatchArrays& patches, ShotPipeline& pipeline, PacketCaster& caster,
                       std::uint32_t resolution, std::uint32_t shooters) {
    std::vector<Aimed> aimed;
    for (std::uint32_t i = 0; i < shooters; ++i) {
        const std::uint32_t patch = i * (patches.patch_count / shooters);
        project_shooter(pipeline, patch);
        const device::Shot shot = pipeline.shot();
        const auto theirs = caster.count({&shot, 1}, resolution);
        if (!is_within_solid(patches, theirs, shot))
            aimed.push_back(
                {patch, shot,
                 disagreement(pipeline.proxel_counts(), theirs, pipeline.disk_proxels())});
    }
    pipeline.clear_counts();
    return aimed;
}

// A shot that halts, because its lists are full, is as fast as it is worthless.
void require_shots(ShotPipeline& pipeline, std::uint64_t shots) {
    if (pipeline.shot().shots != shots) throw InputError("a shot was not finished");
}

std::vector<std::span<const Aimed>> turns_of(std::span<const Aimed> aimed) {
    std::vector<std::span<const Aimed>> turns;
    for (std::size_t first = 0; first < aimed.size(); first += kShotsPerTurn)
        turns.push_back(aimed.subspan(first, std::min(kShotsPerTurn, aimed.size() - first)));
    return turns;
}

void compare_times(const std::vector<Aimed>& aimed, ShotPipeline& pipeline, PacketCaster& caster,
                   const Options& options, Comparison& result) {
    std::vector<double> embree, ours, ratios, processor_ratios;
    for (std::uint32_t round = 0; round < options.rounds; ++round)
        for (const auto turn : turns_of(aimed)) {
            const std::uint64_t before = pipeline.shot().shots;
            const Duration our = time_of([&] {
                for (const Aimed& shooter : turn) {
                    pipeline.set_shooter(shooter.patch);
                    shoot(pipeline);
                }
                pipeline.shot();
            });
            require_shots(pipeline, before + turn.size());
            std::vector<device::Shot> shots;
            for (const Aimed& shooter : turn) shots.push_back(shooter.shot);
            const Duration their = time_of([&] { caster.count(shots, result.resolution); });
            ours.push_back(our.wall_ms / static_cast<double>(turn.size()));
            embree.push_back(their.wall_ms / static_cast<double>(turn.size()));
            ratios.push_back(their.wall_ms / our.wall_ms);
            processor_ratios.push_back(their.processor_ms / our.processor_ms);
        }
    result.embree_ms = median(embree);
    result.hemirad_ms = median(ours);
    result.ratio = median(ratios);
    result.processor_ratio = median(processor_ratios);
}

Comparison compare(const PatchArrays& patches, PacketCaster& caster, std::uint32_t resolution,
                   const Options& options) {
    ShotPipeline pipeline = pipeline_for(patches, resolution);
    const auto aimed =
        aim(patches, pipeline, caster, resolution, std::min(options.shooters, patches.patch_count));
    if (aimed.empty()) throw InputError("every shooter lies within a solid");
    Comparison result;
    result.resolution = resolution;
    result.shooters = aimed.size();
    for (const Aimed& shooter : aimed) {
        result.mean_disagreement += shooter.disagreement / static_cast<double>(aimed.size());
        result.most_disagreement = std::max(result.most_disagreement, shooter.disagreement);
    }
    compare_times(aimed, pipeline, caster, options, result);
    return result;
}

Options parse(int argc, char** argv) {
    Options options;
    CLI::App app("Times shots against rays of the same directions, cast by Embree");
    app.add_option("room", options.scene, "OBJ or glTF file; every polygon is a patch")->required();
    app.add_option("--resolution", options.resolutions, "N,N,...: N x N proxels")
        ->check(CLI::Range(16, 8192))
        ->delimiter(',');
    app.add_option("--shooters", options.shooters, "spread evenly over the patches")
        ->check(CLI::PositiveNumber);
    app.add_option("--rounds", options.rounds, "over all shooters")->check(CLI::PositiveNumber);
    app.add_option("--csv", options.csv, "file for the table");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error));
    }
    return options;
}

void print(const Comparison& row) {
    std::printf(
        "%4u^2 %5zu shooters  Embree %8.3f ms  hemirad %8.3f ms  ratio %6.2f, of "
        "processors' time %6.2f  counts differ "
        "%.2g, at most %.2g of the disk\n",
        row.resolution, row.shooters, row.embree_ms, row.hemirad_ms, row.ratio, row.processor_ratio,
        row.mean_disagreement, row.most_disagreement);
    std::fflush(stdout);
}

void write_csv(const std::string& path, std::uint32_t patches,
               const std::vector<Comparison>& table) {
    std::ofstream file(path);
    file << "patches,resolution,shooters,embree_ms,hemirad_ms,ratio,processor_ratio,mean_"
            "disagreement,"
            "most_disagreement\n";
    for (const Comparison& row : table)
        file << patches << ',' << row.resolution << ',' << row.shooters << ',' << row.embree_ms
             << ',' << row.hemirad_ms << ',' << row.ratio << ',' << row.processor_ratio << ','
             << row.mean_disagreement << ',' << row.most_disagreement << '\n';
    if (!file.flush()) throw OutputError(path + ": cannot be written");
}

// Whether all counts agree.
bool run(const Options& options) {
    MeshSettings settings;
    settings.patch_size = std::numeric_limits<double>::infinity();
    const auto patches = patch_arrays(build_mesh(read_scene(options.scene), settings));
    PacketCaster caster(patches);
    std::printf("%s: %u patches\n", options.scene.c_str(), patches.patch_count);
    std::vector<Comparison> table;
    for (const std::uint32_t resolution : options.resolutions) {
        table.push_back(compare(patches, caster, resolution, options));
        print(table.back());
    }
    if (!options.csv.empty()) write_csv(options.csv, patches.patch_count, table);
    return std::all_of(table.begin(), table.end(), [](const Comparison& row) {
        return row.most_disagreement <= kMostDisagreement;
    });
}

}  // namespace
}  // namespace hemirad

int main(int argc, char** argv) {
    try {
        if (hemirad::run(hemirad::parse(argc, argv))) return 0;
        std::fprintf(stderr, "bench_peer_embree: the counts do not agree\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_peer_embree: %s\n", error.what());
    }
    return 1;
}
