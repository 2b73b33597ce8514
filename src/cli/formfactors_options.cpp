#include "cli/formfactors_options.h"

#include <cmath>

#include "cli/mesh_options.h"
#include "cli/outputs.h"
#include "cli/solve_options.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/atomic_file.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string_view> kFormats{"csv", "view3d", "view3d-sparse"};

void add_file_options(CLI::App& command, FormFactorsOptions& options) {
    add_scene(command, options.scene);
    add_text(command, {"-o,--output", "FILE", "the factors [standard output]"}, options.output);
    add_value(command, {"--format", "csv|view3d|view3d-sparse", "how they are written [csv]"},
              [&](const OptionValue& value) {
                  options.format = static_cast<FactorFormat>(one_of(value, kFormats));
              });
    add_text(command, {"--report", "FILE.json", "what happened, machine-readable"}, options.report);
}

void add_choice_options(CLI::App& command, FormFactorsOptions& options) {
    add_names(command, {"--from", "NAME", "only the rows of this surface; may be repeated"},
              options.from);
    add_names(command, {"--receivers-only", "NAME", "list only this column; may be repeated"},
              options.receivers_only);
    add_names(command,
              {"--blockers-only", "NAME", "this surface hides others, no more; may be repeated"},
              options.blockers_only);
    add_flag(command, "--per-patch", options.per_patch,
             "rows and columns are patches, #0, #1, ...");
    add_flag(command, "--enforce", options.enforce,
             "least squares: A_i F_ij = A_j F_ji, and rows that sum to 1");
}

std::optional<double> target_of(Quality quality) {
    if (quality == Quality::draft) return std::nullopt;
    return std::pow(10.0, -2 - static_cast<int>(quality));
}

void add_accuracy_options(CLI::App& command, FormFactorsOptions& options) {
    const auto* const resolution = add_resolution(command, options.factors.resolution);
    const auto* const samples = add_shooter_samples(command, options.factors.shooter_samples);
    auto* const target = add_value(
        command,
        {"--target-error", "E", "of each factor, absolute; what may err by more is integrated"},
        [&](const OptionValue& value) { options.factors.target_error = fraction(value); });
    auto* const quality = add_quality(
        command,
        "no target, 1e-3, 1e-4 or 1e-5 [medium; draft where hemispheres are chosen by hand]",
        options.quality);
    exclude(target, quality);
    on_understood(command, [&options, resolution, samples, target, quality] {
        const bool by_hand = is_given(resolution) || is_given(samples);
        if (!is_given(target) && (is_given(quality) || !by_hand))
            options.factors.target_error = target_of(options.quality);
    });
    add_mesh_options(command, options.mesh);
    describe(command, "--patch-size",
             "longest edge of a patch; inf: every polygon is one patch [inf]");
}

void insist(bool holds, const std::string& otherwise) {
    if (!holds) throw InputError("hemirad: " + otherwise);
}

/// A scene's own endings are refused, so that a mistaken order of names does no harm.
void check_output_ending(const FormFactorsOptions& options) {
    if (options.format == FactorFormat::csv)
        return check_ending("--output", *options.output, {".csv"});
    const auto ending = options.output->extension();
    for (const char* taken : {".obj", ".mtl", ".gltf", ".glb", ".bin", ".vs3"})
        if (ending == taken) reject({"--output", options.output->native()}, "no scene's ending");
}

}  // namespace

void add_formfactors_options(CLI::App& command, FormFactorsOptions& options) {
    add_file_options(command, options);
    add_choice_options(command, options);
    add_accuracy_options(command, options);
    add_array_options(command, options.device, options.compute_units, options.factors.pe_array);
    add_kernels(command, options.factors.kernels_dir);
    add_flag(command, "-q,--quiet", options.quiet, "say nothing but warnings and faults");
    add_flag(command, "--no-progress", options.no_progress, "no progress bar or lines");
}

void check_formfactors_options(const FormFactorsOptions& options) {
    const bool is_square = options.from.empty() && options.receivers_only.empty();
    insist(options.format == FactorFormat::csv || is_square,
           "--format " + std::string(kFormats[std::size_t(options.format)]) +
               ": a square matrix, not with --from or --receivers-only");
    insist(!options.enforce || options.from.empty(), "--enforce: needs all rows, not with --from");
    if (options.output) check_output_ending(options);
    if (options.report) check_ending("--report", *options.report, {".json"});
    const auto files = output_files(options);
    check_distinct(options.scene, files);
    for (const auto& file : files) check_writable(file);
}

std::vector<fs::path> output_files(const FormFactorsOptions& options) {
    std::vector<fs::path> files;
    if (options.output) files.push_back(*options.output);
    if (options.report) files.push_back(*options.report);
    return files;
}

std::vector<std::pair<std::string, std::string>> deciding_options(
    const FormFactorsOptions& options) {
    const auto& factors = options.factors;
    std::vector<std::pair<std::string, std::string>> result{
        {"--resolution", std::to_string(factors.resolution)},
        {"--shooter-samples",
         factors.shooter_samples == 0 ? "auto" : std::to_string(factors.shooter_samples)},
        {"--patch-size", number_text(options.mesh.patch_size)},
        {"--backfaces", name_of(options.mesh.backfaces)}};
    if (options.mesh.weld > 0) result.emplace_back("--weld", number_text(options.mesh.weld));
    if (factors.target_error)
        result.emplace_back("--target-error", number_text(*factors.target_error));
    for (const auto& [option, names] : {std::pair("--from", &options.from),
                                        std::pair("--receivers-only", &options.receivers_only),
                                        std::pair("--blockers-only", &options.blockers_only)})
        for (const auto& name : *names) result.emplace_back(option, name);
    if (options.per_patch) result.emplace_back("--per-patch", "");
    if (options.enforce) result.emplace_back("--enforce", "");
    return result;
}

}  // namespace hemirad
