#include "cli/info.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "cli/exit_codes.h"
#include "cli/memory.h"
#include "cli/mesh_options.h"
#include "cli/solve_options.h"
#include "cli/summary.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/atlas_contents.h"
#include "lightmap/atlas_file.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "scene/printable.h"
#include "scene/read_scene.h"
#include "scene/short_text.h"
#include "solver/accuracy.h"
#include "solver/bands.h"
#include "solver/dark_backs.h"
#include "solver/solver.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

// As options that give this mesh.
std::string sizes_of(const MeshSettings& settings) {
    const auto patches = "--patch-size " + number_text(settings.patch_size);
    if (settings.element_size == 0) return patches;
    return patches + ", --element-size " + number_text(settings.element_size);
}

void print_contents(std::ostream& out, const Scene& scene, const Mesh& mesh,
                    const MeshSettings& settings) {
    const auto count = [&](auto matches) {
        return std::count_if(mesh.patches.begin(), mesh.patches.end(), matches);
    };
    const auto triangles = count([](const Patch& patch) { return patch.is_triangle(); });
    out << "file         " << printable(scene.file) << '\n'
        << "faces        " << mesh.face_count << " (" << mesh.dropped_degenerate
        << " degenerate and " << mesh.dropped_duplicate << " duplicate ones dropped)\n"
        << "extent       " << extent_text(mesh) << '\n'
        << "objects      " << scene.objects.size() << '\n'
        << "materials    " << scene.materials.size() << '\n'
        << "surfaces     " << mesh.surfaces.size() << '\n'
        << "patches      " << mesh.shooter_count() << '\n'
        << "elements     " << mesh.patches.size() << " (" << triangles << " of them triangles), "
        << sizes_of(settings) << '\n'
        << "precision    " << mesh.weld
        << " m, closer vertices are one (--weld): " << mesh.input.welded << " welded, "
        << mesh.input.moved << " moved onto edges\n"
        << "faults       " << counted(mesh.input.split, "face") << " split, "
        << counted(mesh.input.overlapping, "overlap") << ", "
        << counted(mesh.input.inside_out, "room") << " inside out\n";
}

std::string object_names(const Mesh& mesh, const std::vector<std::uint32_t>& objects) {
    constexpr std::size_t kInFull = 3;
    return names_in_short(objects.size(), kInFull,
                          [&](std::size_t i) { return printable(mesh.objects[objects[i]]); });
}

/// Why a part got the backs it has, sec. 1.5.1 being right for closed solids only.
std::string backs_of(const Part& part) {
    std::string text = part.closed ? "closed" : "open";
    if (part.doubled) text += ", double-sided";
    if (part.back_patches == 0) return text + ", no backs";
    return text + ", " + counted(part.back_patches, "back");
}

void print_parts(std::ostream& out, const Mesh& mesh, Backfaces backfaces) {
    constexpr std::size_t kInFull = 40;
    out << "parts        " << mesh.parts.size() << ", --backfaces " << name_of(backfaces) << '\n';
    for (std::size_t i = 0; i < std::min(mesh.parts.size(), kInFull); ++i) {
        const auto& part = mesh.parts[i];
        out << "  " << object_names(mesh, part.objects) << ": " << counted(part.face_count, "face")
            << ", " << backs_of(part) << '\n';
    }
    if (mesh.parts.size() > kInFull) out << "  and " << mesh.parts.size() - kInFull << " more\n";
    out << "scene        "
        << (mesh.closed ? "closed: no light can escape\n" : "open: light may escape\n");
}

void print_bands(std::ostream& out, const Mesh& mesh) {
    const auto plan = plan_bands(mesh);
    out << "bands        ";
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        out << (band == 0 ? "" : " ") << printable(mesh.bands[band]);
    out << "; solved: " << plan.solved.size();
    if (plan.solved.size() < mesh.bands.size())
        out << ", since others have the same reflectances and proportional emission";
    out << '\n';
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        out << "  " << printable(mesh.bands[band]) << ": emits "
            << rounded_text(emitted_flux(mesh, band)) << " W, solved as "
            << printable(mesh.bands[plan.solved[plan.solution[0][band]].band]) << '\n';
}

double flux_of(const Mesh& mesh, const LightGroups& lights, std::uint32_t light) {
    double flux = 0;
    for (std::size_t band = 0; band < mesh.bands.size(); ++band)
        flux += emitted_flux(mesh, lights, {.band = band, .light = light});
    return flux;
}

// What --lights tells apart, whether or not it is asked to.
void print_lights(std::ostream& out, const Mesh& mesh, Lights wanted) {
    constexpr std::size_t kInFull = 40;
    const auto how = wanted == Lights::together ? Lights::separate : wanted;
    const auto plan = plan_bands(mesh, {.lights = how});
    const auto& names = plan.lights.names;
    out << "lights       " << names.size();
    if (names.empty())
        out << ": nothing emits light, solve will refuse";
    else
        out << "; --lights " << name_of(how) << " solves " << counted(plan.solved.size(), "band");
    out << '\n';
    for (std::uint32_t i = 0; i < std::min(names.size(), kInFull); ++i)
        out << "  " << printable(names[i]) << ": emits "
            << rounded_text(flux_of(mesh, plan.lights, i)) << " W in all bands\n";
    if (names.size() > kInFull) out << "  and " << names.size() - kInFull << " more\n";
}

/// Seconds before the first shot, kernels from the cache, and of shooting.
struct TimeEstimate {
    double preparing = 0;
    std::optional<Forecast> shooting;
};

TimeEstimate estimate_time(const Mesh& mesh, const SolverSettings& settings,
                           const mp1map::Device& device) {
    const Stopwatch watch;
    ProgressiveSolver solver(mesh, settings, device);
    const double preparing = watch.seconds() - solver.build_seconds();
    return {preparing, solver.forecast()};
}

/// Why nothing can be foretold, if so.
std::optional<std::string> doubt_of_time(const Mesh& mesh, const SolveOptions& options,
                                         const MemoryEstimate& memory, std::uint64_t limit) {
    if (!emits_light(mesh)) return "nothing emits light, so there is nothing to solve";
    if (options.target_error) return "--target-error: as many solves as it needs";
    if (options.mesh.split_levels > 0) return "--split: several solves, of meshes not known yet";
    if (memory.bytes() + memory.compiler_bytes > limit) return "not enough memory to find out";
    return {};
}

void print_time(std::ostream& out, const std::string& what, const Mesh& mesh,
                const SolverSettings& settings, const mp1map::Device& device) {
    out << what;
    try {
        const auto estimate = estimate_time(mesh, settings, device);
        if (estimate.shooting)
            out << time_text(*estimate.shooting);
        else
            out << "unknown: to find out takes more than " << number_text(kMostForecastSeconds)
                << " s";
        out << "; " << duration_text(estimate.preparing) << " before\n";
    } catch (const InputError& fault) {
        out << printable(fault.what()) << '\n';
    }
}

std::string texels_text(const AtlasContents& atlas) {
    const double texels = 1.0 * atlas.width * atlas.height;
    return size_text(atlas.width, atlas.height) + " texels of " + rounded_text(atlas.texel_size) +
           " m, " + percent_text(atlas.filled / texels) + " filled";
}

// Files as solve names them where it is not told otherwise.
void print_lightmaps(std::ostream& out, const Scene& scene, const Mesh& mesh,
                     const ChartLayout& layout, const SolveOptions& options) {
    constexpr std::size_t kInFull = 10;
    const auto atlases = atlas_contents(scene, mesh, layout);
    out << "lightmaps    " << atlases.size() << '\n';
    for (std::uint32_t i = 0; i < std::min(atlases.size(), kInFull); ++i)
        out << "  " << printable(atlas_file(options.scene.stem().string() + ".exr", i).string())
            << ": " << texels_text(atlases[i]) << ", " << counted(atlases[i].chart_count, "chart")
            << ": " << object_names(mesh, atlases[i].objects) << '\n';
    if (atlases.size() > kInFull) out << "  and " << atlases.size() - kInFull << " more\n";
}

/// Printed as the memory's line: what else there is to tell of the scene is told.
std::optional<ChartLayout> layout_or_fault(std::ostream& out, const Scene& scene, const Mesh& mesh,
                                           const SolveOptions& options) {
    try {
        return lay_out_charts(scene, mesh, options.charts);
    } catch (const InputError& fault) {
        out << "memory       none, no lightmap: " << printable(fault.what()) << '\n';
        return {};
    }
}

void print_cost(std::ostream& out, const Mesh& mesh, const ChartLayout& layout,
                const SolveOptions& options) {
    if (mp1map::list_devices().empty()) {
        out << "memory       no device to estimate it for\n";
        return;
    }
    const auto device = mp1map::Device::open(options.device, options.compute_units);
    const auto limit = options.memory_limit.value_or(available_memory());
    const auto memory =
        estimate_memory(mesh, layout, options, device.summary(), peak_memory_bytes());
    out << "device       " << printable(device.summary().name) << ", "
        << bytes_text(device.summary().global_memory) << '\n'
        << "memory       " << memory_text(memory) << (options.memory_limit ? "; limit " : "; free ")
        << bytes_text(limit) << '\n';
    if (const auto doubt = doubt_of_time(mesh, options, memory, limit)) {
        out << "time         " << *doubt << '\n';
        return;
    }
    print_time(out, "time         ", mesh, options.solver, device);
    if (options.estimate_error)
        print_time(out, "  and again  ", mesh, for_comparison(options.solver), device);
}

int print_info(SolveOptions options, std::ostream& out) {
    const auto scene = read_scene(options.scene);
    if (options.mesh.patch_size == 0) options.mesh.patch_size = default_patch_size(scene);
    require_memory_for_mesh(scene, options.mesh, options.memory_limit, options.device);
    auto mesh = build_mesh(scene, options.mesh);
    if (options.lit_backs_only) drop_dark_backs(mesh);
    if (const auto fault = uncountable_light(mesh)) throw InputError(scene.file + ": " + *fault);
    print_contents(out, scene, mesh, options.mesh);
    print_parts(out, mesh, options.mesh.backfaces);
    print_bands(out, mesh);
    print_lights(out, mesh, options.solver.parts.lights);
    if (const auto layout = layout_or_fault(out, scene, mesh, options)) {
        print_lightmaps(out, scene, mesh, *layout, options);
        print_cost(out, mesh, *layout, options);
    }
    const auto warnings = warnings_of(scene, mesh);
    out << "warnings     " << warnings.size() << '\n';
    for (const auto& warning : warnings) out << "  " << printable(warning) << '\n';
    return kDone;
}

}  // namespace

void add_info(CLI::App& app, Command& chosen) {
    auto& command =
        add_command(app, "info", "what a scene holds and what the solver will therefore build");
    const auto options = std::make_shared<SolveOptions>();
    add_cost_options(command, *options);
    on_chosen(command, [&chosen, options] {
        if (!options->target_error)
            set_accuracy(options->solver, accuracy_at(static_cast<unsigned>(options->quality)));
        chosen = [options] { return print_info(*options, std::cout); };
    });
}

}  // namespace hemirad
