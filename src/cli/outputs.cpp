#include "cli/outputs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cli/checkpoint_file.h"
#include "cli/layered_lightmap.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/atlas_file.h"
#include "lightmap/atomic_file.h"
#include "lightmap/rasterize.h"
#include "lightmap/write_exr.h"
#include "lightmap/write_gltf.h"
#include "lightmap/write_preview.h"
#include "scene/printable.h"
#include "solver/ambient.h"
#include "view/lit_scene.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

/// The same for every way to write a file's name; weakly_canonical alone leaves "a" as it is where
/// there is no such file yet, a link as well. A folder that nobody may look into has its own fault
/// told later.
fs::path place_of(const fs::path& file) {
    std::error_code fault;
    const fs::path absolute = fs::absolute(link_target(file), fault);
    if (fault)
        throw OutputError(printable(file.string()) + ": no current folder: " + fault.message());
    const fs::path place = fs::weakly_canonical(absolute, fault);
    return fault ? absolute.lexically_normal() : place;
}

std::vector<fs::path> all_files(const SolveOptions& options) {
    std::vector<fs::path> files = output_files(options);
    if (options.report) files.push_back(*options.report);
    if (options.checkpoint) files.push_back(*options.checkpoint);
    return files;
}

void keep_resumed(const SolveOptions& options, const std::vector<fs::path>& files) {
    for (const auto& file : files)
        if (place_of(file) == place_of(*options.resume) && file != options.checkpoint)
            throw InputError("hemirad: " + printable(file.string()) +
                             ": would overwrite the checkpoint of --resume");
}

/// Which there will be cannot be told; these would be replaced where there are as many shots again.
std::vector<fs::path> snapshots_there(const SolveOptions& options) {
    std::vector<fs::path> files;
    if (!options.snapshots.kept) return files;
    for (std::uint32_t atlas = 0; atlas < options.atlas_count; ++atlas) {
        const fs::path exr = atlas_file(options.output, atlas);
        for (const auto shots : shots_kept(exr)) files.push_back(snapshot_file(exr, shots));
    }
    return files;
}

/// Where one of the files could be a snapshot that is to be kept, however many shots there will be.
void keep_off_snapshots(const SolveOptions& options, std::vector<fs::path> files) {
    if (!options.snapshots.kept) return;
    if (options.resume) files.push_back(*options.resume);
    for (std::uint32_t atlas = 0; atlas < options.atlas_count; ++atlas) {
        const fs::path exr = atlas_file(options.output, atlas);
        for (const auto& file : files) {
            const auto shots = shots_in_name(exr, place_of(file));
            if (shots && place_of(snapshot_file(exr, *shots)) == place_of(file))
                throw InputError("hemirad: " + printable(file.string()) +
                                 ": could be overwritten by a snapshot of --keep-snapshots");
        }
    }
}

/// Emission may be up to what a double holds, a lightmap only what a float does.
void check_finite(const fs::path& file, const Lightmap& lightmap) {
    const auto check = [&](const std::vector<std::vector<float>>& bands) {
        for (const auto& values : bands)
            if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v); }))
                throw OutputError(printable(file.string()) +
                                  ": values are beyond the range of float");
    };
    check(lightmap.values);
    for (const auto& [name, layer] : lightmap.layers) check(layer.values);
}

/// Below, digits are lost; half has no std::numeric_limits without OpenEXR.
double least_normal(PixelType type) {
    return type == PixelType::half ? 0x1p-14 : double{std::numeric_limits<float>::min()};
}

/// Of a picture that was gathered, or of what patches show.
std::string settings_text(SolveOptions options, bool gathered) {
    if (!gathered) options.gather.reset();
    std::string text;
    for (const auto& [name, value] : deciding_options(options))
        text += (text.empty() ? "" : " ") + name + " " + value;
    return text;
}

std::vector<Attribute> attributes_of(const SolveOptions& options, const Solution& solution,
                                     bool gathered) {
    auto attributes = describe(solution, options.quantity);
    attributes.push_back({"version", std::string(HEMIRAD_VERSION)});
    attributes.push_back({"scene", options.scene.filename().string()});
    attributes.push_back({"resolution", double(options.solver.resolution)});
    attributes.push_back({"shooter_samples", double(options.solver.shooter_samples)});
    attributes.push_back({"settings", settings_text(options, gathered)});
    return attributes;
}

void write_lightmap(const SolveOptions& options, std::uint32_t atlas, const Lightmap& lightmap,
                    const std::vector<Attribute>& attributes) {
    const fs::path file = atlas_file(options.output, atlas);
    check_finite(file, lightmap);
    write_exr(file, lightmap, attributes, options.pixels);
    if (options.preview) write_preview(atlas_file(*options.preview, atlas), lightmap);
}

}  // namespace

std::vector<fs::path> output_files(const SolveOptions& options) {
    std::vector<fs::path> files;
    for (std::uint32_t atlas = 0; atlas < options.atlas_count; ++atlas) {
        files.push_back(atlas_file(options.output, atlas));
        if (options.preview) files.push_back(atlas_file(*options.preview, atlas));
    }
    if (options.gltf) files.push_back(*options.gltf);
    if (options.faces) files.push_back(*options.faces);
    return files;
}

void check_ending(std::string_view option, const fs::path& file,
                  std::initializer_list<std::string_view> endings) {
    if (std::ranges::count(endings, file.extension().native()) > 0) return;
    std::error_code ignored;
    // That it is a folder is told by check_writable().
    if (is_device_or_pipe(file) || fs::is_directory(file, ignored)) return;
    std::string names;
    for (const auto* ending = endings.begin(); ending != endings.end(); ++ending)
        names += (names.empty()                 ? ""
                  : ending + 1 == endings.end() ? " or "
                                                : ", ") +
                 std::string(*ending);
    reject({option, file.native()}, "a name ending in " + names);
}

void check_distinct(const fs::path& scene, const std::vector<fs::path>& files) {
    std::vector<fs::path> taken{place_of(scene)};
    for (const auto& file : files) {
        const auto place = place_of(file);
        for (const auto& other : taken)
            if (place == other && !is_device_or_pipe(place))
                throw InputError("hemirad: " + printable(file.string()) + ": would overwrite " +
                                 (other == taken.front() ? "the scene" : "another output"));
        taken.push_back(place);
    }
}

void keep_side_files(const Scene& scene, const std::vector<fs::path>& files) {
    std::set<fs::path> places;
    for (const auto& side_file : scene.side_files) places.insert(place_of(side_file));
    std::error_code ignored;
    for (const auto& file : files)
        if (places.contains(place_of(file)) && fs::exists(file, ignored))
            throw InputError("hemirad: " + printable(file.string()) +
                             ": would overwrite a file of the scene");
}

void check_side_files(const SolveOptions& options, const Scene& scene) {
    keep_side_files(scene, all_files(options));
    keep_side_files(scene, snapshots_there(options));
}

void check_outputs(const SolveOptions& options) {
    if (options.gltf)
        check_ending("--output", options.output, {".exr"});
    else
        check_ending("--output", options.output, {".exr", ".glb", ".gltf"});
    if (options.gltf) check_ending("--gltf", *options.gltf, {".glb", ".gltf"});
    if (options.preview) check_ending("--preview", *options.preview, {".png"});
    if (options.faces) check_ending("--faces", *options.faces, {".csv"});
    if (options.report) check_ending("--report", *options.report, {".json"});
    const auto files = all_files(options);
    check_distinct(options.scene, files);
    if (options.resume) keep_resumed(options, files);
    keep_off_snapshots(options, files);
    if (options.checkpoint) require_no_other_file(*options.checkpoint);
    for (const auto& file : files) check_writable(file);
}

std::vector<std::size_t> write_picture(const SolveOptions& options, const Mesh& mesh,
                                       const ChartLayout& layout, const Solution& solution,
                                       const Solution* error, const GatheredLightmaps* gathered) {
    std::vector<std::size_t> covered;
    for (std::uint32_t atlas = 0; atlas < layout.atlases.size(); ++atlas) {
        const auto lightmap =
            layered_lightmap(options, mesh, layout, atlas, solution, error, gathered);
        write_lightmap(options, atlas, lightmap,
                       attributes_of(options, solution, gathered != nullptr));
        covered.push_back(static_cast<std::size_t>(
            std::ranges::count_if(lightmap.coverage, [](float part) { return part > 0; })));
    }
    return covered;
}

void write_solved_scene(const SolveOptions& options, const Scene& scene,
                        const std::vector<Camera>& cameras, const Mesh& mesh,
                        const ChartLayout& layout, const Solution& solution,
                        const GatheredLightmaps* gathered) {
    if (!options.gltf) return;
    const auto folder = fs::absolute(*options.gltf).parent_path();
    ChartLayout downwards = layout;  // as V always runs in glTF
    downwards.flip_v = false;
    std::vector<LightmapImage> images;
    for (std::uint32_t atlas = 0; atlas < layout.atlases.size(); ++atlas) {
        Lightmap lightmap = rasterize(mesh, solution, layout, Quantity::irradiance, atlas);
        if (gathered != nullptr)
            put_gathered(options, mesh, solution, gathered->atlases[atlas], Quantity::irradiance,
                         lightmap.values);
        images.push_back(lightmap_image(lightmap));
    }
    write_gltf(*options.gltf, scene, mesh, cameras, lightmap_uvs(scene, mesh, downwards), images,
               place_of(options.output).lexically_relative(place_of(folder)));
}

std::optional<std::string> write_interim_picture(const SolveOptions& options, const Scene& scene,
                                                 const std::vector<Camera>& cameras,
                                                 const Mesh& mesh, const ChartLayout& layout,
                                                 const Solution& solution) try {
    auto attributes = attributes_of(options, solution, false);
    attributes.push_back({"ambient", std::string("what is unshot, spread evenly")});
    const Solution lit = with_ambient(mesh, solution);
    for (std::uint32_t atlas = 0; atlas < layout.atlases.size(); ++atlas) {
        const auto lightmap = layered_lightmap(options, mesh, layout, atlas, lit, nullptr);
        write_lightmap(options, atlas, lightmap, attributes);
        if (options.snapshots.kept)
            write_exr(snapshot_file(atlas_file(options.output, atlas), solution.shots), lightmap,
                      attributes, options.pixels);
    }
    write_solved_scene(options, scene, cameras, mesh, layout, lit);
    return {};
} catch (const OutputError& fault) {
    return fault.what();
}

std::vector<std::string> faint_bands(const SolveOptions& options, const Solution& solution) {
    const double least = least_normal(options.pixels);
    const auto& bands =
        options.quantity == Quantity::irradiance ? solution.irradiance : solution.radiosity;
    std::vector<std::string> faint;
    for (std::size_t band = 0; band < bands.size(); ++band) {
        const double brightest = *std::ranges::max_element(bands[band]);
        if (brightest > 0 && brightest < least)
            faint.push_back(options.output.string() + ": band \"" + solution.bands[band] +
                            "\" holds " + number_text(brightest) +
                            " W/m^2 at most, less than its pixels' " + number_text(least) +
                            ": digits are lost");
    }
    return faint;
}

}  // namespace hemirad
