#include "cli/sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/interrupts.h"
#include "cli/memory.h"
#include "cli/option_values.h"
#include "cli/outputs.h"
#include "cli/solve_options.h"
#include "cli/sweep_csv.h"
#include "cli/sweep_plan.h"
#include "cli/text.h"
#include "errors.h"
#include "scene/mesh.h"
#include "scene/printable.h"
#include "scene/read_scene.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

/// The halls then have the paper's 2,000 and 14,000 patches, see scenes/README.md.
constexpr double kHallPatchSize = 0.43;
/// Of --smoke: some tens of patches.
constexpr double kSmokePatchSize = 3;
constexpr std::uint32_t kSmokeShots = 3;

struct SweepOptions {
    std::vector<std::string> scenes;
    fs::path output = "sweep.csv";
    std::string device;
    double patch_size = 0;    ///< 0: the halls' own, else from the scene's extent
    std::uint32_t shots = 0;  ///< 0: 20, fewer for --smoke
    bool smoke = false, quiet = false;
};

/// Beside the program, as installed and as built; else here.
fs::path hall(const std::string& name) {
    std::error_code fault;
    const fs::path program = fs::read_symlink("/proc/self/exe", fault).parent_path();
    for (const auto& folder :
         {program / "../share/hemirad/scenes", program / "../scenes", fs::path("scenes")})
        if (fs::exists(folder / name)) return folder / name;
    throw InputError("hemirad: scenes/" + name + " is not there; name the scenes to sweep");
}

std::vector<fs::path> scenes_of(const SweepOptions& options) {
    if (!options.scenes.empty()) return {options.scenes.begin(), options.scenes.end()};
    if (options.smoke) return {hall("hall2k.obj")};
    return {hall("hall2k.obj"), hall("hall14k.obj")};
}

double patch_size_of(const SweepOptions& options, const Scene& scene, const fs::path& file) {
    if (options.patch_size > 0) return options.patch_size;
    if (options.smoke) return kSmokePatchSize;
    const auto name = file.stem();
    const bool is_hall = name == "hall2k" || name == "hall14k";
    return is_hall ? kHallPatchSize : default_patch_size(scene);
}

std::string milliseconds(double seconds) {
    return number_text(std::round(seconds * 1e6) / 1e3) + " ms";
}

/// A scene as its rows name it, and its shots.
struct Swept {
    std::string name;
    double patch_size;
    SweepScene scene;
};

std::vector<Swept> read_scenes(const SweepOptions& options) {
    const std::uint32_t shots = options.shots != 0 ? options.shots
                                : options.smoke    ? kSmokeShots
                                                   : 20;
    std::vector<Swept> result;
    for (const auto& file : scenes_of(options)) {
        const auto scene = read_scene(file);
        check_distinct(file, {options.output});
        keep_side_files(scene, {options.output});
        const double patch_size = patch_size_of(options, scene, file);
        require_memory_for_mesh(scene, {.patch_size = patch_size}, {}, options.device);
        const auto mesh = build_mesh(scene, {.patch_size = patch_size});
        result.push_back({file.stem().string(), patch_size, SweepScene(patch_arrays(mesh), shots)});
    }
    return result;
}

/// Seconds left, from what has been done so far. Points of one lane take several times as long.
class Remaining {
  public:
    void add(double weight) { left_ += weight; }
    double after(double weight) {
        left_ -= weight;
        done_ += weight;
        const auto passed = std::chrono::steady_clock::now() - start_;
        return std::chrono::duration<double>(passed).count() / done_ * std::max(left_, 0.0);
    }
    void skip(double weight) { left_ -= weight; }

  private:
    double left_ = 0, done_ = 0;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Relative; the constant is for building the kernels.
double weight_of(const Swept& swept, const SweepPoint& point) {
    const double plane = point.resolution / 1024.;
    const double patches = swept.scene.patches().patch_count / 14000.;
    const double lanes = point.pe_array.lanes == 1 ? 4 : 1;
    return 1 + lanes * (patches + plane * plane / 2) + (point.variants.incremental ? 2 : 0);
}

class Sweep {
  public:
    explicit Sweep(const SweepOptions& options)
        : options_(options),
          all_(mp1map::Device::open(options.device)),
          plan_(options.smoke ? smoke_plan() : sweep_plan(all_.summary())),
          scenes_(read_scenes(options)),
          csv_(options.output) {
        for (const auto& swept : scenes_)
            for (const auto& planned : plan_) remaining_.add(weight_of(swept, planned.point));
    }

    int run() {
        const Interrupts interrupts;
        for (auto& swept : scenes_)
            for (const auto& planned : plan_) {
                if (interrupts.requested()) return kInterrupted;
                take(swept, planned);
            }
        if (options_.smoke) check_shape(options_.output, rows_);
        return kDone;
    }

  private:
    // Sub-devices live as long as the sweep: PoCL 3.1 has crashed in builds after one was released.
    const mp1map::Device& device_of(std::uint32_t units) {
        if (units == 0) return all_;
        const auto found = parts_.find(units);
        if (found != parts_.end()) return found->second;
        return parts_.emplace(units, mp1map::Device::open(options_.device, units)).first->second;
    }

    void take(Swept& swept, const PlannedPoint& planned) {
        ++taken_;
        const double weight = weight_of(swept, planned.point);
        const auto& device = device_of(planned.compute_units);
        const SweepRow row{swept.name,
                           swept.patch_size,
                           swept.scene.patches().patch_count,
                           static_cast<std::uint32_t>(swept.scene.shooters().size()),
                           planned,
                           device.summary()};
        try {
            const auto settings = settings_text(row);
            ++rows_;
            if (csv_.holds(settings)) return remaining_.skip(weight);
            measure_row(swept, row, settings, device);
        } catch (const mp1map::NoSuchDevice& fault) {
            say("skipped, " + std::string(fault.what()));
            return remaining_.skip(weight);
        }
    }

    void measure_row(Swept& swept, const SweepRow& row, const std::string& settings,
                     const mp1map::Device& device) {
        const auto& point = row.planned.point;
        const auto measured = measure(swept.scene, point, device);
        const std::string wrong = point.variants.incremental
                                      ? number_text(wrong_per_million(swept.scene, point, device))
                                      : "";
        csv_.append(settings, measured, wrong);
        const double left = remaining_.after(weight_of(swept, point));
        say(title(row) + ": " + milliseconds(measured.seconds_median) + " a shot; " +
            duration_text(left) + " left");
    }

    void say(const std::string& what) const {
        if (options_.quiet) return;
        std::cerr << "[" << taken_ << "/" << plan_.size() * scenes_.size() << "] "
                  << printable(what) << '\n';
    }

    SweepOptions options_;
    mp1map::Device all_;
    std::map<std::uint32_t, mp1map::Device> parts_;
    std::vector<PlannedPoint> plan_;
    std::vector<Swept> scenes_;
    SweepCsv csv_;
    Remaining remaining_;
    std::size_t taken_ = 0, rows_ = 0;
};

void add_sweep_options(CLI::App& command, SweepOptions& options) {
    add_files(command, {"SCENE", "", "scenes to sweep [the two halls]"}, options.scenes);
    add_text(command,
             {"-o,--output", "FILE.csv",
              "a row a machine; goes on where it ended "
              "[sweep.csv]"},
             options.output);
    add_value(command, {"--shots", "N", "shots a row, spread over the scene [20]"},
              [&](const OptionValue& value) {
                  options.shots = static_cast<std::uint32_t>(whole_number(value, 1, 100000));
              });
    add_value(command, {"--patch-size", "S", "longest edge of a patch, m [0.43 for the halls]"},
              [&](const OptionValue& value) { options.patch_size = positive_or_infinite(value); });
    add_device(command, options.device);
    add_flag(command, "--smoke", options.smoke, "few small points, and check the CSV's shape");
    add_flag(command, "-q,--quiet", options.quiet, "no progress");
}

}  // namespace

void add_sweep(CLI::App& app, Command& chosen) {
    auto& command =
        add_command(app, "sweep", "time and counts of single shots on many PE arrays, as CSV");
    const auto options = std::make_shared<SweepOptions>();
    add_sweep_options(command, *options);
    on_chosen(command,
              [&chosen, options] { chosen = [options] { return Sweep(*options).run(); }; });
}

}  // namespace hemirad
