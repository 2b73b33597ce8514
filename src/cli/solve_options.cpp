#include "cli/solve_options.h"

#include <cmath>
#include <limits>

#include "cli/mesh_options.h"
#include "cli/text.h"
#include "errors.h"

namespace hemirad {
namespace {

const std::vector<std::string_view> kChartSources{"authored", "generated"};
const std::vector<std::string_view> kBacks{"all", "lit"};
const std::vector<std::string_view> kQuantities{"irradiance", "radiosity"};
const std::vector<std::string_view> kQualities{"draft", "medium", "high", "ultra"};
const std::vector<std::string_view> kFormFactorModes{"count", "analytic"};
const std::vector<std::string_view> kLights{"together", "separate", "by-material"};
const std::vector<std::string_view> kLayers{"direct",   "indirect", "emission", "normal",
                                            "position", "shots",    "coverage", "error"};
constexpr auto kAny = std::numeric_limits<std::uint64_t>::max();

void add_preview(CLI::App& command, std::optional<std::filesystem::path>& file) {
    add_text(command, {"--preview", "FILE.png", "the lightmap tone-mapped, to look at"}, file);
}

void add_file_options(CLI::App& command, SolveOptions& options) {
    add_scene(command, options.scene);
    begin_group(command, "Output");
    add_text(command,
             {"-o,--output", "FILE.exr|.glb|.gltf",
              "the lightmap, or --gltf with the lightmap beside it [SCENE's name .exr, here]"},
             options.output);
    add_text(command, {"--gltf", "FILE.glb|.gltf", "the scene with its lightmap, for engines"},
             options.gltf);
    add_preview(command, options.preview);
    add_text(command, {"--faces", "FILE.csv", "the solution as numbers, a row a polygon"},
             options.faces);
    add_text(command, {"--report", "FILE.json", "what happened, machine-readable"}, options.report);
}

void add_accuracy_options(CLI::App& command, SolveOptions& options) {
    auto& solver = options.solver;
    begin_group(command, "Accuracy");
    auto* const quality = add_quality(
        command, "resolution, samples and sampling error in one [medium]", options.quality);
    auto* const target =
        add_value(command,
                  {"--target-error", "E",
                   "finer until the irradiance of these patches is off by E of its mean, RMS"},
                  [&](const OptionValue& value) { options.target_error = fraction(value); });
    exclude(target, quality);
    add_flag(command, "--estimate-error", options.estimate_error,
             "by a second solution: into the report, and into the EXR as layer error");
    exclude(target, add_resolution(command, solver.resolution));
    exclude(target, add_shooter_samples(command, solver.shooter_samples));
    add_value(command,
              {"--form-factor", "count|analytic",
               "proxels counted, or closed form times visible fraction [analytic]"},
              [&](const OptionValue& value) {
                  solver.form_factor = static_cast<FormFactorMode>(one_of(value, kFormFactorModes));
              });
    add_value(
        command,
        {"--sampling-error", "E", "closed forms where one hemisphere errs by more [by --quality]"},
        [&](const OptionValue& value) { solver.sampling_error = positive_number(value); });
    begin_group(command, "Mesh");
    add_mesh_options(command, options.mesh);
    add_element_size(command, options.mesh);
    add_split(command, options.mesh);
}

void add_chart_options(CLI::App& command, SolveOptions& options) {
    auto& charts = options.charts;
    begin_group(command, "Lightmap");
    add_value(command, {"--texel-size", "METRES", "edge of a texel [half a patch's edge]"},
              [&](const OptionValue& value) { charts.texel_size = positive_number(value); });
    add_value(command,
              {"--atlas-size", "N",
               "longest side of a lightmap, texels; more are written where one is not enough "
               "[16384]"},
              [&](const OptionValue& value) {
                  charts.atlas_size =
                      static_cast<std::uint32_t>(whole_number(value, 1, kLargestAtlas));
              });
    add_value(command, {"--padding", "N", "gutter around every chart, texels [4]"},
              [&](const OptionValue& value) {
                  charts.padding = static_cast<std::uint32_t>(whole_number(value, 0, 256));
              });
    add_value(command,
              {"--charts", "authored|generated",
               "the scene's TEXCOORD_1 where it has one, or new ones throughout [authored]"},
              [&](const OptionValue& value) {
                  charts.source = static_cast<ChartSource>(one_of(value, kChartSources));
              });
    add_value(
        command,
        {"--backs", "all|lit",
         "which backs of double-sided faces get charts: those that closed walls part from all "
         "lamps are black [all]"},
        [&](const OptionValue& value) { options.lit_backs_only = one_of(value, kBacks) == 1; });
    add_flag(command, "--flip-v", charts.flip_v,
             "V runs up from the lightmap's bottom row, not down from its top [off]");
}

void add_gather(CLI::App& command, SolveOptions& options) {
    add_value(command,
              {"--gather", "N",
               "texels look through N x N proxels of their own; not from patches' light [off]"},
              [&](const OptionValue& value) {
                  options.gather = static_cast<std::uint32_t>(whole_number(value, 16, 8192));
              });
    need(command,
         add_value(command,
                   {"--gather-error", "E",
                    "gathered light is interpolated up to an error of E of it; 0: nowhere [0.01]"},
                   [&](const OptionValue& value) {
                       options.gather_error = value.text == "0" ? 0 : fraction(value);
                   }),
         "--gather");
}

void add_memory_limit(CLI::App& command, std::optional<std::uint64_t>& limit) {
    add_value(command,
              {"--memory-limit", "SIZE",
               "refuse, before the work begins, what needs more, e.g. 8G, 500M [what is free]"},
              [&](const OptionValue& value) { limit = byte_count(value); });
}

void add_stop_options(CLI::App& command, SolverSettings& solver) {
    begin_group(command, "Ends and limits");
    add_value(command, {"--tolerance", "T", "stop where unshot / emitted flux is below T [1e-3]"},
              [&](const OptionValue& value) { solver.tolerance = fraction(value); });
    add_value(command, {"--max-shots", "N", "stop after N shots"},
              [&](const OptionValue& value) { solver.max_shots = whole_number(value, 1, kAny); });
    add_value(command, {"--time-limit", "SECONDS", "stop after so long"},
              [&](const OptionValue& value) { solver.time_limit = positive_number(value); });
}

SnapshotInterval snapshot_interval(const OptionValue& value) {
    constexpr auto* kAccepted = "a number of shots, such as 100, or of seconds, such as 10s";
    try {
        if (!value.text.ends_with('s')) return {whole_number(value, 1, kAny), 0};
        return {0, positive_number({value.option, value.text.substr(0, value.text.size() - 1)})};
    } catch (const InputError&) {
        reject(value, kAccepted);
    }
}

void add_checkpoint_options(CLI::App& command, SolveOptions& options) {
    begin_group(command, "On the way");
    add_text(
        command,
        {"--checkpoint", "FILE", "where to leave, now and then and at the end, what to go on from"},
        options.checkpoint);
    need(
        command,
        add_value(
            command,
            {"--checkpoint-every", "SHOTS|SECONDSs", "how often the checkpoint is written [60s]"},
            [&](const OptionValue& value) { options.checkpoint_every = snapshot_interval(value); }),
        "--checkpoint");
    add_text(command,
             {"--resume", "FILE", "go on from a checkpoint of the same scene and settings"},
             options.resume);
}

void add_snapshot_every(CLI::App& command, SnapshotInterval& snapshots) {
    begin_group(command, "On the way");
    add_value(command,
              {"--snapshot-every", "SHOTS|SECONDSs",
               "write the picture so far, what is unshot spread evenly"},
              [&](const OptionValue& value) {
                  const bool kept = snapshots.kept;
                  snapshots = snapshot_interval(value);
                  snapshots.kept = kept;
              });
}

// Of the EXR; coverage is there anyway.
void wish_for(const OptionValue& layer, SolveOptions& options) {
    bool coverage = true;
    bool* const wishes[] = {&options.solver.parts.direct,
                            &options.solver.parts.indirect,
                            &options.layers.emission,
                            &options.layers.normal,
                            &options.layers.position,
                            &options.solver.count_shots,
                            &coverage,
                            &options.estimate_error};
    *wishes[one_of(layer, kLayers)] = true;
}

void add_layers(CLI::App& command, SolveOptions& options) {
    add_value(command,
              {"--layers", "NAME,...",
               "further layers of the EXR: direct, indirect, emission, normal, position, shots, "
               "error; coverage is always there"},
              [&](const OptionValue& value) {
                  for (std::size_t first = 0; first <= value.text.size();) {
                      const auto end = std::min(value.text.find(',', first), value.text.size());
                      wish_for({value.option, value.text.substr(first, end - first)}, options);
                      first = end + 1;
                  }
              });
}

void add_pixel_options(CLI::App& command, SolveOptions& options) {
    add_flag(
        command, "--half", [&] { options.pixels = PixelType::half; }, "16-bit floats in the EXR");
    add_lights(command, options.solver.parts.lights);
    add_layers(command, options);
}

void add_picture_options(CLI::App& command, SolveOptions& options) {
    begin_group(command, "Lightmap");
    add_value(command,
              {"--quantity", "irradiance|radiosity", "what the lightmap holds, W/m^2 [irradiance]"},
              [&](const OptionValue& value) {
                  options.quantity = static_cast<Quantity>(one_of(value, kQuantities));
              });
    add_pixel_options(command, options);
    add_snapshot_every(command, options.snapshots);
    need(command,
         add_flag(command, "--keep-snapshots", options.snapshots.kept,
                  "each also as NAME-SHOTS.exr, which hemirad view plays"),
         "--snapshot-every");
}

std::uint32_t lanes(const OptionValue& value) {
    constexpr std::uint32_t kLanes[] = {1, 4, 8, 16};
    return kLanes[one_of(value, {"1", "4", "8", "16"})];
}

void add_plane_options(CLI::App& command, mp1map::PeArrayRequest& array) {
    add_value(command, {"--layout", "cyclic|block", "how proxels are dealt to the PEs [cyclic]"},
              [&](const OptionValue& value) {
                  array.layout = static_cast<mp1map::Layout>(one_of(value, {"cyclic", "block"}));
              });
    add_value(command, {"--broadcast", "patch|batch|level", "patches diffused at a time [batch]"},
              [&](const OptionValue& value) {
                  array.broadcast =
                      static_cast<mp1map::Broadcast>(one_of(value, {"patch", "batch", "level"}));
              });
}

void add_variant_options(CLI::App& command, Variants& variants) {
    add_value(command,
              {"--evaluate", "direct|incremental",
               "arcs in further areas: anew, or by deltas "
               "that drift [direct]"},
              [&](const OptionValue& value) {
                  variants.incremental = one_of(value, {"direct", "incremental"}) == 1;
              });
    add_value(command,
              {"--accumulate", "histogram|xnet", "how form factors are gathered [histogram]"},
              [&](const OptionValue& value) {
                  variants.xnet = one_of(value, {"histogram", "xnet"}) == 1;
              });
    add_value(command, {"--distance", "true|constant", "of each proxel, or one a patch [true]"},
              [&](const OptionValue& value) {
                  variants.constant_distance = one_of(value, {"true", "constant"}) == 1;
              });
}

void add_machine_options(CLI::App& command, SolveOptions& options) {
    begin_group(command, "Machine");
    add_array_options(command, options.device, options.compute_units, options.solver.pe_array);
    add_variant_options(command, options.solver.variants);
    add_value(command,
              {"--row-memory", "MIB",
               "for form factors of those who shoot again [1024, or 0 for large meshes]"},
              [&](const OptionValue& value) {
                  options.solver.row_bytes = whole_number(value, 0, 1u << 24) << 20;
              });
    add_value(command,
              {"--salvo", "N", "patches that shoot at once [8; 1 for small and very large meshes]"},
              [&](const OptionValue& value) {
                  options.solver.salvo =
                      static_cast<std::uint32_t>(whole_number(value, 1, kMostSalvo));
              });
    add_kernels(command, options.solver.kernels_dir);
}

std::string layers_text(const SolveOptions& options) {
    std::string text;
    const std::pair<bool, const char*> wishes[] = {
        {options.solver.parts.direct, "direct"}, {options.solver.parts.indirect, "indirect"},
        {options.layers.emission, "emission"},   {options.layers.normal, "normal"},
        {options.layers.position, "position"},   {options.solver.count_shots, "shots"}};
    for (const auto& [wished, name] : wishes)
        if (wished) text += (text.empty() ? "" : ",") + std::string(name);
    return text;
}

void add_talk_options(CLI::App& command, SolveOptions& options) {
    begin_group(command, "Messages");
    auto* const quiet =
        add_flag(command, "-q,--quiet", options.quiet, "say nothing but warnings and faults");
    exclude(add_flag(command, "-v,--verbose", options.verbose, "say more"), quiet);
    add_flag(command, "--no-progress", options.no_progress, "no progress bar or lines");
}

void add_work_options(CLI::App& command, SolveOptions& options) {
    add_accuracy_options(command, options);
    add_chart_options(command, options);
    add_gather(command, options);
    add_stop_options(command, options.solver);
    add_memory_limit(command, options.memory_limit);
}

}  // namespace

void add_solve_options(CLI::App& command, SolveOptions& options) {
    add_file_options(command, options);
    add_work_options(command, options);
    add_checkpoint_options(command, options);
    add_picture_options(command, options);
    add_machine_options(command, options);
    add_talk_options(command, options);
}

void add_cost_options(CLI::App& command, SolveOptions& options) {
    add_scene(command, options.scene);
    begin_group(command, "Output");
    add_preview(command, options.preview);
    add_work_options(command, options);
    begin_group(command, "Lightmap");
    add_pixel_options(command, options);
    add_snapshot_every(command, options.snapshots);
    add_machine_options(command, options);
}

void add_scene(CLI::App& command, std::filesystem::path& scene) {
    require(add_text(command, {"SCENE", "", "a .gltf, .glb, .obj or .vs3 file"}, scene));
}

CLI::Option* add_quality(CLI::App& command, const std::string& meaning, Quality& quality) {
    return add_value(command, {"--quality", "draft|medium|high|ultra", meaning},
                     [&](const OptionValue& value) {
                         quality = static_cast<Quality>(one_of(value, kQualities));
                     });
}

CLI::Option* add_resolution(CLI::App& command, std::uint32_t& resolution) {
    const auto standard = resolution == 0 ? "by --quality" : std::to_string(resolution);
    return add_value(
        command,
        {"--resolution", "N", "N x N proxels on the square around the disk [" + standard + "]"},
        [&](const OptionValue& value) {
            resolution = static_cast<std::uint32_t>(whole_number(value, 16, 8192));
        });
}

CLI::Option* add_shooter_samples(CLI::App& command, std::uint32_t& samples) {
    return add_value(command,
                     {"--shooter-samples", "M|auto",
                      "hemispheres a shooting patch, M x M; auto: by --quality, where proxels are "
                      "counted by what is near [auto]"},
                     [&samples, automatic = samples](const OptionValue& value) {
                         samples = value.text == "auto"
                                       ? automatic
                                       : static_cast<std::uint32_t>(whole_number(value, 1, 64));
                     });
}

void add_lights(CLI::App& command, Lights& lights) {
    add_value(
        command,
        {"--lights", "together|separate|by-material",
         "a layer light.NAME of the EXR for each object that emits, or each such material "
         "[together]"},
        [&](const OptionValue& value) { lights = static_cast<Lights>(one_of(value, kLights)); });
}

void add_device(CLI::App& command, std::string& device) {
    add_text(command,
             {"--device", "NAME|INDEX", "part of a name, or index, of hemirad devices [PoCL CPU]"},
             device);
}

void add_array_options(CLI::App& command, std::string& device, std::uint32_t& compute_units,
                       mp1map::PeArrayRequest& array) {
    add_device(command, device);
    add_value(command, {"--compute-units", "K", "of the device's [all]"},
              [&](const OptionValue& value) {
                  compute_units = static_cast<std::uint32_t>(whole_number(value, 1, 65536));
              });
    add_value(command, {"--pe", "WxH", "work-items of the PE array [fit for the device]"},
              [&](const OptionValue& value) {
                  const auto [width, height] = extent(value);
                  array.width = width;
                  array.height = height;
              });
    add_value(command, {"--lanes", "1|4|8|16", "proxels a PE takes at once [fit for the device]"},
              [&](const OptionValue& value) { array.lanes = lanes(value); });
    add_value(command,
              {"--tile", "WxH", "proxels a work-group keeps in local memory [fit for the device]"},
              [&](const OptionValue& value) {
                  const auto [width, height] = extent(value);
                  array.tile_width = width;
                  array.tile_height = height;
              });
    add_plane_options(command, array);
}

void add_kernels(CLI::App& command, std::optional<std::filesystem::path>& folder) {
    add_text(command, {"--kernels", "FOLDER", "read the kernels from here, not from the program"},
             folder);
}

std::vector<std::pair<std::string, std::string>> deciding_options(const SolveOptions& options) {
    const auto& solver = options.solver;
    std::vector<std::pair<std::string, std::string>> result{
        {"--resolution", std::to_string(solver.resolution)},
        {"--shooter-samples",
         solver.shooter_samples == 0 ? "auto" : std::to_string(solver.shooter_samples)},
        {"--form-factor", name_of(solver.form_factor)},
        {"--sampling-error", number_text(solver.sampling_error)},
        {"--patch-size", number_text(options.mesh.patch_size)},
        {"--texel-size", number_text(options.charts.texel_size)},
        {"--padding", std::to_string(options.charts.padding)},
        {"--backfaces", name_of(options.mesh.backfaces)},
        {"--max-reflectance", number_text(options.mesh.max_reflectance)},
        {"--tolerance", number_text(solver.tolerance)},
        {"--quantity", name_of(options.quantity)}};
    if (options.mesh.element_size > 0)
        result.emplace_back("--element-size", number_text(options.mesh.element_size));
    if (options.mesh.split_levels > 0)
        result.emplace_back("--split", std::to_string(options.mesh.split_levels));
    if (options.charts.atlas_size > 0)
        result.emplace_back("--atlas-size", std::to_string(options.charts.atlas_size));
    if (options.charts.source == ChartSource::generated)
        result.emplace_back("--charts", "generated");
    if (options.lit_backs_only) result.emplace_back("--backs", "lit");
    if (options.charts.flip_v) result.emplace_back("--flip-v", "");
    if (options.mesh.weld > 0) result.emplace_back("--weld", number_text(options.mesh.weld));
    if (options.target_error)
        result.emplace_back("--target-error", number_text(*options.target_error));
    if (solver.salvo != 0) result.emplace_back("--salvo", std::to_string(solver.salvo));
    if (solver.parts.lights != Lights::together)
        result.emplace_back("--lights", name_of(solver.parts.lights));
    if (const auto layers = layers_text(options); !layers.empty())
        result.emplace_back("--layers", layers);
    if (solver.max_shots != SolverSettings{}.max_shots)
        result.emplace_back("--max-shots", std::to_string(solver.max_shots));
    if (std::isfinite(solver.time_limit))
        result.emplace_back("--time-limit", number_text(solver.time_limit));
    if (options.gather) {
        result.emplace_back("--gather", std::to_string(*options.gather));
        result.emplace_back("--gather-error", number_text(options.gather_error));
    }
    if (options.pixels == PixelType::half) result.emplace_back("--half", "");
    if (solver.variants.incremental) result.emplace_back("--evaluate", "incremental");
    if (solver.variants.constant_distance) result.emplace_back("--distance", "constant");
    return result;
}

std::string name_of(FormFactorMode mode) {
    return std::string(kFormFactorModes[static_cast<std::size_t>(mode)]);
}

std::string name_of(Lights lights) {
    return std::string(kLights[static_cast<std::size_t>(lights)]);
}

std::string name_of(Quantity quantity) {
    return std::string(kQuantities[static_cast<std::size_t>(quantity)]);
}

}  // namespace hemirad
