#include "cli/render.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/outputs.h"
#include "cli/summary.h"
#include "cli/text.h"
#include "cli/view.h"
#include "errors.h"
#include "lightmap/atomic_file.h"
#include "lightmap/png.h"
#include "lightmap/write_exr.h"
#include "scene/bounds.h"
#include "scene/printable.h"
#include "scene/short_text.h"
#include "view/lit_scene.h"
#include "view/picture_of.h"
#include "view/render.h"

namespace hemirad {
namespace {

struct RenderOptions {
    std::filesystem::path scene, output;  ///< output empty: the scene's name with .png, here
    std::optional<std::filesystem::path> lightmap;
    std::string camera;
    std::optional<glm::dvec3> eye, look_at;
    glm::dvec3 up{0, 1, 0};
    std::optional<double> fov;  ///< radians
    std::optional<Extent> size;
    RenderSettings render;
    std::optional<double> exposure, largest;
    bool false_colour = false, quiet = false;
};

glm::dvec3 point(const OptionValue& value) {
    const auto [x, y, z] = coordinates(value);
    return {x, y, z};
}

double angle(const OptionValue& value) {
    const double degrees = positive_number(value);
    if (degrees >= 180) reject(value, "degrees, above 0 and below 180");
    return glm::radians(degrees);
}

void add_camera_options(CLI::App& command, RenderOptions& options) {
    auto* const camera = add_text(
        command, {"--camera", "NAME", "one of the scene's [its only one]"}, options.camera);
    exclude(camera, add_value(command, {"--eye", "X,Y,Z", "or look from here, metres"},
                              [&](const OptionValue& value) { options.eye = point(value); }));
    auto* const look_at = add_value(
        command, {"--look-at", "X,Y,Z", "this shall be in the middle [the scene's middle]"},
        [&](const OptionValue& value) { options.look_at = point(value); });
    auto* const up = add_value(command, {"--up", "X,Y,Z", "what is up from --eye [0,1,0]"},
                               [&](const OptionValue& value) { options.up = point(value); });
    add_value(command, {"--fov", "DEGREES", "from top to bottom [the camera's; 45]"},
              [&](const OptionValue& value) { options.fov = angle(value); });
    for (auto* const option : {look_at, up}) need(command, option, "--eye");
}

void add_tone_options(CLI::App& command, RenderOptions& options) {
    auto* const exposure = add_value(
        command,
        {"--exposure", "X", "white is 1 - exp(-X radiance) [nine tenths below 80 % white]"},
        [&](const OptionValue& value) { options.exposure = positive_number(value); });
    auto* const false_colour =
        add_value(command,
                  {"--false-colour", "[MAX]",
                   "irradiance, all bands added, up to MAX W/m^2 [nearly all of it]"},
                  [&](const OptionValue& value) {
                      options.false_colour = true;
                      if (!value.text.empty()) options.largest = positive_number(value);
                  });
    let_stand_alone(false_colour);
    exclude(exposure, false_colour);
}

void add_picture_options(CLI::App& command, RenderOptions& options) {
    add_text(command,
             {"-o,--output", "FILE.png|.exr",
              "the picture, or radiance in W/(m^2 sr) [SOLVED's name .png, here]"},
             options.output);
    add_value(command, {"--size", "WxH", "pixels [800x600, or 600 high in the camera's shape]"},
              [&](const OptionValue& value) { options.size = extent(value); });
    add_value(command, {"--samples", "N", "N x N rays a pixel [3]"}, [&](const OptionValue& value) {
        options.render.samples = static_cast<std::uint32_t>(whole_number(value, 1, 32));
    });
    add_text(command, {"--layer", "NAME", "a layer of the lightmap alone"}, options.render.layer);
    add_tone_options(command, options);
}

[[noreturn]] void fail(const Scene& scene, const std::string& reason) {
    throw InputError(scene.file + ": " + reason);
}

/// A few, and how many more.
std::string names_of(const std::vector<Camera>& cameras) {
    constexpr std::size_t kNamed = 5;
    return names_in_short(cameras.size(), kNamed, [&](std::size_t i) { return cameras[i].name; });
}

Camera named_camera(const LitScene& lit, const std::string& name) {
    const auto& cameras = lit.cameras;
    if (name.empty() && cameras.size() == 1) return cameras[0];
    const auto found = std::ranges::find(cameras, name, &Camera::name);
    if (!name.empty() && found != cameras.end()) return *found;
    if (cameras.empty()) fail(lit.scene, "has no cameras; --eye X,Y,Z needs none");
    fail(lit.scene, (name.empty() ? "" : "no camera \"" + printable(name) + "\"; it ") +
                        "has the cameras " + names_of(cameras) +
                        "; --camera names one, --eye X,Y,Z needs none");
}

Camera own_camera(const Scene& scene, const RenderOptions& options) {
    Camera camera{"eye", *options.eye};
    const glm::dvec3 ahead = options.look_at.value_or(bounds_of(scene).middle()) - camera.eye;
    const glm::dvec3 right = glm::cross(ahead, options.up);
    if (!(glm::length(right) > 1e-9 * glm::length(ahead) * glm::length(options.up)))
        fail(scene, "--eye looks along --up, or nowhere; --look-at and --up say where");
    camera.forward = ahead / glm::length(ahead);
    camera.up = glm::normalize(glm::cross(right, ahead));
    camera.yfov = glm::radians(45.0);
    return camera;
}

void choose_size(const RenderOptions& options, const Camera& camera, RenderSettings& settings) {
    if (options.size) {
        settings.width = options.size->width;
        settings.height = options.size->height;
    } else if (camera.aspect > 0) {
        settings.width = static_cast<std::uint32_t>(
            std::clamp(std::round(settings.height * camera.aspect), 1.0, 8192.0));
    }
}

std::vector<std::string> warnings_of(const RenderOptions& options, const Lightmap& rendered) {
    const auto all_zero = [](const std::vector<float>& values) {
        return std::ranges::all_of(values, [](float value) { return value <= 0; });
    };
    if (all_zero(rendered.coverage))
        return {options.output.string() + ": the camera sees nothing of the scene"};
    if (std::ranges::all_of(rendered.values, all_zero))
        return {options.output.string() + ": nothing that the camera sees is lit"};
    return {};
}

void write_radiance(const RenderOptions& options, const LitScene& lit, const Camera& camera,
                    const Lightmap& rendered) {
    write_exr(options.output, rendered,
              {{"version", std::string(HEMIRAD_VERSION)},
               {"scene", lit.scene.file},
               {"camera", camera.name},
               {"quantity", std::string("radiance")},
               {"unit", std::string("W/(m^2 sr)")}});
}

/// Its size, that of a scale below it included, and what a second one needs to be shown alike.
std::string write_picture(const RenderOptions& options, const Lightmap& rendered,
                          const std::string& camera) {
    const double exposure = options.exposure.value_or(automatic_exposure(rendered));
    const Picture picture = options.false_colour
                                ? false_colours_of(rendered, options.largest, "irradiance, W/m^2")
                                : picture_of(rendered, exposure);
    write_atomically(options.output, [&](std::ostream& stream) { write_png(stream, picture); });
    return size_text(picture.width, picture.height) + " from " + camera +
           (options.false_colour ? ", its scale included"
                                 : ", --exposure " + number_text(exposure));
}

void check_output(RenderOptions& options) {
    if (options.output.empty()) options.output = options.scene.stem().string() + ".png";
    check_ending("--output", options.output, {".png", ".exr"});
    check_distinct(options.scene, {options.output});
    check_writable(options.output);
    if (options.output.extension() == ".exr" && (options.false_colour || options.exposure))
        throw InputError(
            "hemirad: --exposure and --false-colour need a .png, an .exr holds "
            "radiance");
}

int render_scene(RenderOptions options) {
    check_output(options);
    const LitScene lit = read_lit_scene(options.scene, options.lightmap);
    keep_side_files(lit.scene, {options.output});
    auto camera = options.eye ? own_camera(lit.scene, options) : named_camera(lit, options.camera);
    camera.yfov = options.fov.value_or(camera.yfov);
    choose_size(options, camera, options.render);
    if (options.false_colour) options.render.shown = Shown::irradiance;
    const Lightmap rendered = render(lit, camera, options.render);
    std::string note = size_text(rendered.width, rendered.height) + " from " + camera.name;
    if (options.output.extension() == ".exr")
        write_radiance(options, lit, camera, rendered);
    else
        note = write_picture(options, rendered, camera.name);
    print_warnings(std::cerr, warnings_of(options, rendered));
    if (!options.quiet) std::cerr << printable(options.output.string()) << ": " << note << '\n';
    return kDone;
}

}  // namespace

void add_render(CLI::App& app, Command& chosen) {
    auto& command = add_command(app, "render", "a picture of a solved scene");
    const auto options = std::make_shared<RenderOptions>();
    add_lit_scene(command, options->scene, options->lightmap);
    add_camera_options(command, *options);
    add_picture_options(command, *options);
    add_flag(command, "-q,--quiet", options->quiet, "say nothing but warnings and faults");
    on_chosen(command,
              [&chosen, options] { chosen = [options] { return render_scene(*options); }; });
}

}  // namespace hemirad
