#include "cli/tradeoff.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/interrupts.h"
#include "cli/mesh_options.h"
#include "cli/outputs.h"
#include "cli/solve_options.h"
#include "cli/text.h"
#include "cli/tradeoff_csv.h"
#include "cli/tradeoff_factors.h"
#include "cli/tradeoff_plan.h"
#include "cli/tradeoff_solves.h"
#include "errors.h"
#include "lightmap/atomic_file.h"
#include "scene/mesh.h"
#include "scene/printable.h"
#include "scene/read_scene.h"
#include "solver/bands.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

/// The finest of tradeoff's patches over those of solve, so that the many solves end in minutes.
constexpr double kDefaultScale = 4;

struct TradeoffOptions {
    fs::path scene, output = "tradeoff.csv";
    MeshSettings mesh;
    std::string device;
    bool quick = false, quiet = false;
};

/// Like %.3g, whatever the locale.
std::string three_digits(double number) {
    std::array<char, 16> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number,
                                   std::chars_format::general, 3);
    return {text.data(), end.ptr};
}

std::string square(std::uint32_t side) { return std::to_string(side) + "x" + std::to_string(side); }

std::string title(const FactorPoint& point) {
    std::string text = "factors, " + name_of(point.method) + ", " + name_of(point.runs_on) + ", ";
    if (point.method == Method::monte_carlo) return text + counted(point.rays, "ray");
    text += square(point.resolution) + ", " + square(point.shooter_samples) + " points";
    if (point.plane_half_width > 0) text += ", half width " + number_text(point.plane_half_width);
    return text;
}

std::string title(const SolvePoint& point, double patch_size) {
    return "solve, " + name_of(point.method) + ", " + square(point.resolution) + ", " +
           square(point.shooter_samples) + " points, patch size " + number_text(patch_size);
}

MeshSettings mesh_settings(const TradeoffOptions& options, const Scene& scene) {
    MeshSettings settings = options.mesh;
    if (settings.patch_size == 0) settings.patch_size = kDefaultScale * default_patch_size(scene);
    return settings;
}

class Tradeoff {
  public:
    explicit Tradeoff(const TradeoffOptions& options)
        : options_(options),
          plan_(options.quick ? quick_tradeoff_plan() : tradeoff_plan()),
          scene_(read_scene(options.scene)),
          mesh_settings_(mesh_settings(options, scene_)),
          device_(mp1map::Device::open(options.device)) {
        check_ending("--output", options.output, {".csv"});
        check_distinct(options.scene, {options.output});
        keep_side_files(scene_, {options.output});
        check_writable(options.output);
    }

    int run() {
        const Mesh mesh = build_mesh(scene_, mesh_settings_);
        take_factors(mesh);
        if (emits_light(mesh))
            take_solves();
        else
            say("nothing emits light, so there is nothing to solve");
        if (interrupts_.requested() && taken_ == 0) {
            say("interrupted: nothing is written");
            return kInterrupted;
        }
        csv_.write(options_.output);
        return interrupts_.requested() ? kInterrupted : kDone;
    }

  private:
    TradeoffScene row_scene(double patch_size, std::size_t patches) const {
        return {options_.scene.stem().string(), patch_size, patches};
    }

    void take_factors(const Mesh& mesh) {
        const auto scene = row_scene(mesh_settings_.patch_size, mesh.patches.size());
        say("true factors of " + counted(plan_.shooters, "patch", "patches"));
        const FactorRows rows(mesh, plan_.shooters, plan_.truth_error, device_,
                              [&] { return !interrupts_.requested(); });
        for (const auto& point : plan_.factors) {
            const auto measured = rows.measure(point);
            if (!measured) return;
            csv_.add(scene, point, rows.row_count(), *measured);
            ++taken_;
            say(title(point) + ": " + three_digits(measured->errors.rms) + " rms, " +
                three_digits(1e3 * measured->seconds) + " ms a row");
        }
    }

    void take_solves() {
        const auto go_on = [&](const Progress&) { return !interrupts_.requested(); };
        Solves solves(scene_, mesh_settings_, plan_.finest, device_, go_on);
        for (const auto& point : plan_.solves) {
            if (interrupts_.requested()) return;
            const double patch_size = mesh_settings_.patch_size * point.patch_scale;
            const auto measured = solves.measure(point);
            if (interrupts_.requested()) return;
            csv_.add(row_scene(patch_size, solves.patch_count(point.patch_scale)), point, measured);
            ++taken_;
            say(title(point, patch_size) + ": " + three_digits(measured.errors.patches_rms) +
                " rms, " + three_digits(measured.errors.faces_rms) + " of faces, " +
                duration_text(measured.seconds));
        }
    }

    void say(const std::string& what) const {
        if (options_.quiet) return;
        std::cerr << "[" << taken_ << "/" << plan_.factors.size() + plan_.solves.size() << "] "
                  << printable(what) << '\n';
    }

    TradeoffOptions options_;
    TradeoffPlan plan_;
    Scene scene_;
    MeshSettings mesh_settings_;
    mp1map::Device device_;
    TradeoffCsv csv_;
    std::size_t taken_ = 0;
    Interrupts interrupts_;
};

void add_tradeoff_options(CLI::App& command, TradeoffOptions& options) {
    add_scene(command, options.scene);
    add_text(command, {"-o,--output", "FILE.csv", "a row a setting [tradeoff.csv]"},
             options.output);
    add_mesh_options(command, options.mesh);
    add_device(command, options.device);
    add_flag(command, "--quick", options.quick, "few settings of few proxels");
    add_flag(command, "-q,--quiet", options.quiet, "no progress");
}

}  // namespace

void add_tradeoff(CLI::App& app, Command& chosen) {
    auto& command = add_command(
        app, "tradeoff", "error against time and samples, of form factors and of solves, as CSV");
    const auto options = std::make_shared<TradeoffOptions>();
    add_tradeoff_options(command, *options);
    on_chosen(command,
              [&chosen, options] { chosen = [options] { return Tradeoff(*options).run(); }; });
}

}  // namespace hemirad
