#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/options.h"
#include "lightmap/chart_layout.h"
#include "lightmap/lightmap.h"
#include "lightmap/write_exr.h"
#include "scene/mesh.h"
#include "solver/accuracy.h"
#include "solver/solver.h"

namespace hemirad {

/// How often the picture so far is written, or the checkpoint; both 0: not.
struct SnapshotInterval {
    std::uint64_t shots = 0;
    double seconds = 0;
    bool kept = false;  ///< each also in a file of its own, snapshot_file()
};

/// What the EXR holds besides light.
struct LayerWishes {
    bool emission = false, normal = false, position = false;
};

struct SolveOptions {
    std::filesystem::path scene, output;  ///< output empty: the scene's name with .exr, here
    std::optional<std::filesystem::path> gltf, preview, faces, report;
    std::optional<std::filesystem::path> checkpoint, resume;
    MeshSettings mesh;
    /// A resolution, samples or sampling error of 0 is the dial's: set_accuracy().
    SolverSettings solver = {.resolution = 0, .sampling_error = 0};
    Quality quality = Quality::medium;
    std::optional<double> target_error;  ///< relative RMS of the patches' irradiance
    bool estimate_error = false;
    ChartSettings charts;
    bool lit_backs_only = false;          ///< drop_dark_backs()
    std::optional<std::uint32_t> gather;  ///< N: texels look through N x N proxels of their own
    double gather_error = 0.01;           ///< of what they then interpolate
    std::uint32_t atlas_count = 1;        ///< as the layout of the scene's charts turns out
    Quantity quantity = Quantity::irradiance;
    PixelType pixels = PixelType::float32;
    LayerWishes layers;
    std::string device;  ///< as mp1map::Device::open takes it
    std::uint32_t compute_units = 0;
    std::optional<std::uint64_t> memory_limit;  ///< bytes; else what the machine has to spare
    SnapshotInterval snapshots, checkpoint_every = {.seconds = 60};
    bool quiet = false, verbose = false, no_progress = false;
};

void add_solve_options(CLI::App& command, SolveOptions& options);

/// Those that decide on memory and time, of info.
void add_cost_options(CLI::App& command, SolveOptions& options);

/// SCENE, of all that read one.
void add_scene(CLI::App& command, std::filesystem::path& scene);

CLI::Option* add_quality(CLI::App& command, const std::string& meaning, Quality& quality);

/// --resolution, of solve, info and formfactors.
CLI::Option* add_resolution(CLI::App& command, std::uint32_t& resolution);

/// --shooter-samples; `samples` holds what auto stands for.
CLI::Option* add_shooter_samples(CLI::App& command, std::uint32_t& samples);

/// --lights, of solve and info.
void add_lights(CLI::App& command, Lights& lights);

void add_device(CLI::App& command, std::string& device);

/// --device to --tile, --layout and --broadcast.
void add_array_options(CLI::App& command, std::string& device, std::uint32_t& compute_units,
                       mp1map::PeArrayRequest& array);

void add_kernels(CLI::App& command, std::optional<std::filesystem::path>& folder);

/// The options that decide on the result, as name and value, defaults resolved: the device
/// and most of the machine model are not among them, since they change no bit.
std::vector<std::pair<std::string, std::string>> deciding_options(const SolveOptions& options);

std::string name_of(Quantity quantity);
std::string name_of(Lights lights);
std::string name_of(FormFactorMode mode);

}  // namespace hemirad
