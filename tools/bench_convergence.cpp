// What is still unshot, against shots and seconds, by the settings of `hemirad solve --quality
// draft`. `bench_convergence SCENE`; seconds are those of the solve. PoCL compiles kernels at their
// first launch, so it is the second run that counts.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "errors.h"
#include "scene/read_scene.h"
#include "solver/accuracy.h"

namespace hemirad {
namespace {

// Samples lie no closer than this in shots, nor than two looks of the host at the device.
constexpr double kShotsBetweenSamples = 1.05;
constexpr std::array kThresholds = {0.1, 0.03, 0.01, 0.003, 0.001, 3e-4, 1e-4};

struct Options {
    std::string scene;
    MeshSettings mesh;
    double tolerance = 1e-3;
    std::uint64_t row_mebibytes = 1024;
    std::uint32_t salvo = 0;
    std::string csv;
};

struct Sample {
    double shots, repeated_shots, seconds, unshot_fraction;
    Solution solution;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

SolverSettings settings_of(const Options& options) {
    SolverSettings settings;
    settings.resolution = settings.shooter_samples = 0;
    settings.sampling_error = 0;
    set_accuracy(settings, accuracy_at(static_cast<unsigned>(Quality::draft)));
    settings.tolerance = options.tolerance;
    settings.row_bytes = options.row_mebibytes << 20;
    settings.salvo = options.salvo;
    return settings;
}

// The seconds are without those that the samples take.
std::vector<Sample> curve_of(const Mesh& mesh, const SolverSettings& settings) {
    ProgressiveSolver solver(mesh, settings, mp1map::Device::open(""));
    std::vector<Sample> curve;
    double sampling = 0, last = 0;
    const auto sample = [&](const Progress& progress) {
        const auto start = std::chrono::steady_clock::now();
        const auto shots = static_cast<double>(progress.shots);
        curve.push_back({shots, static_cast<double>(solver.repeated_shots()),
                         progress.seconds - sampling, progress.unshot_fraction, solver.solution()});
        last = shots;
        sampling += seconds_since(start);
    };
    Progress latest;
    solver.solve([&](const Progress& progress) {
        latest = progress;
        if (static_cast<double>(progress.shots) > kShotsBetweenSamples * last) sample(progress);
        return true;
    });
    if (static_cast<double>(latest.shots) > last) sample(latest);
    return curve;
}

void write_csv(const std::string& path, const Mesh& mesh, const std::vector<Sample>& curve) {
    std::ofstream file(path);
    file << "shots,repeated_shots,seconds,unshot_fraction,rms_to_end\n";
    for (const Sample& sample : curve)
        file << sample.shots << ',' << sample.repeated_shots << ',' << sample.seconds << ','
             << sample.unshot_fraction << ','
             << relative_rms_difference(mesh, sample.solution, curve.back().solution) << '\n';
    if (!file.flush()) throw OutputError(path + ": cannot be written");
}

// Between samples what is unshot falls like a power of the shots; the share of the way from a to b.
double share_of_way(const Sample& a, const Sample& b, double threshold) {
    return std::log(threshold / a.unshot_fraction) /
           std::log(b.unshot_fraction / a.unshot_fraction);
}

void print(const std::vector<Sample>& curve) {
    std::printf("%10s %10s %10s\n", "unshot", "shots", "seconds");
    std::size_t i = 1;
    for (const double threshold : kThresholds) {
        while (i < curve.size() && curve[i].unshot_fraction > threshold) ++i;
        if (i >= curve.size()) break;
        const Sample &a = curve[i - 1], &b = curve[i];
        const double share = std::max(0.0, share_of_way(a, b, threshold));
        std::printf("%10g %10.0f %10.3f\n", threshold,
                    std::exp(std::lerp(std::log(a.shots), std::log(b.shots), share)),
                    std::lerp(a.seconds, b.seconds, share));
    }
}

Options parse(int argc, char** argv) {
    Options options;
    CLI::App app("What is unshot, against shots and seconds");
    app.add_option("scene", options.scene, "OBJ or glTF file")->required();
    app.add_option("--patch-size", options.mesh.patch_size, "m")->check(CLI::PositiveNumber);
    app.add_option("--element-size", options.mesh.element_size, "m")->check(CLI::PositiveNumber);
    app.add_option("--row-memory", options.row_mebibytes, "MiB; 0: every shot projects")
        ->check(CLI::Range(0, 1 << 24));
    app.add_option("--salvo", options.salvo, "patches that shoot at once")
        ->check(CLI::Range(1u, kMostSalvo));
    app.add_option("--tolerance", options.tolerance, "unshot / emitted at the end")
        ->check(CLI::PositiveNumber);
    app.add_option("--csv", options.csv, "file for the curve");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        std::exit(app.exit(error));
    }
    return options;
}

void run(Options options) {
    const Scene scene = read_scene(options.scene);
    if (options.mesh.patch_size == 0) options.mesh.patch_size = default_patch_size(scene);
    const Mesh mesh = build_mesh(scene, options.mesh);
    if (!emits_light(mesh)) throw InputError(options.scene + ": nothing emits light");
    const auto curve = curve_of(mesh, settings_of(options));
    const Sample& end = curve.back();
    std::printf("%s: %zu shooters, %zu elements, %.0f shots of which %.0f repeated, %.2f s\n",
                options.scene.c_str(), mesh.shooter_count(), mesh.patches.size(), end.shots,
                end.repeated_shots, end.seconds);
    print(curve);
    if (!options.csv.empty()) write_csv(options.csv, mesh, curve);
}

}  // namespace
}  // namespace hemirad

int main(int argc, char** argv) {
    try {
        hemirad::run(hemirad::parse(argc, argv));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_convergence: %s\n", error.what());
        return 1;
    }
}
