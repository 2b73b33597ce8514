#include "cli/solve.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "cli/checkpoint_file.h"
#include "cli/checkpoints.h"
#include "cli/exit_codes.h"
#include "cli/interrupts.h"
#include "cli/layered_lightmap.h"
#include "cli/memory.h"
#include "cli/outcome.h"
#include "cli/outputs.h"
#include "cli/progress_display.h"
#include "cli/report.h"
#include "cli/shot_clock.h"
#include "cli/snapshots.h"
#include "cli/solve_identity.h"
#include "cli/solve_options.h"
#include "cli/summary.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/atlas_contents.h"
#include "lightmap/atlas_file.h"
#include "lightmap/find_splits.h"
#include "lightmap/write_faces.h"
#include "scene/printable.h"
#include "scene/read_scene.h"
#include "solver/accuracy.h"
#include "solver/bands.h"
#include "solver/dark_backs.h"
#include "solver/find_shooter_splits.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

/// Everything known before the first shot. The mesh is the scene's; both are needed to the end.
struct Work {
    Scene scene;
    std::vector<Camera> cameras;           ///< for those who look at the solved scene
    std::optional<Checkpoint> checkpoint;  ///< of --resume
    Mesh mesh;
    ChartLayout layout;
    std::uint64_t prepare_bytes = 0;  ///< at the peak of all that
    MemoryEstimate memory = {};
};

/// A glTF as output means both: engines read its PNG, measurements the EXR beside it.
void choose_outputs(SolveOptions& options) {
    if (options.output.empty()) options.output = options.scene.stem().string() + ".exr";
    const auto ending = options.output.extension();
    if (options.gltf || (ending != ".glb" && ending != ".gltf")) return;
    options.gltf = options.output;
    options.output.replace_extension(".exr");
}

Work prepare(SolveOptions& options) {
    choose_outputs(options);
    check_outputs(options);
    Work work;
    if (options.resume) work.checkpoint = read_checkpoint(*options.resume);
    work.scene = read_scene(options.scene);
    check_side_files(options, work.scene);
    if (options.gltf) work.cameras = read_cameras(options.scene);
    if (options.mesh.patch_size == 0) options.mesh.patch_size = default_patch_size(work.scene);
    if (options.mesh.element_size > options.mesh.patch_size)
        work.scene.warnings.push_back(
            "--element-size " + number_text(options.mesh.element_size) + " is above --patch-size " +
            number_text(options.mesh.patch_size) + ": a patch is its own element");
    require_memory_for_mesh(work.scene, options.mesh, options.memory_limit, options.device);
    work.mesh = build_mesh(work.scene, options.mesh);
    if (options.lit_backs_only) drop_dark_backs(work.mesh);
    work.layout = lay_out_charts(work.scene, work.mesh, options.charts);
    for (const auto& warning : work.layout.warnings) work.scene.warnings.push_back(warning);
    options.charts.texel_size = work.layout.texel_size;
    options.atlas_count = static_cast<std::uint32_t>(work.layout.atlases.size());
    if (options.atlas_count > 1) check_outputs(options), check_side_files(options, work.scene);
    return work;
}

/// A file of many objects that fill the atlas each is told in one line; the report has them all.
std::vector<std::string> moved_in_short(const std::vector<std::string>& moved) {
    constexpr std::size_t kInFull = 3;
    if (moved.size() <= kInFull) return moved;
    std::string line = std::to_string(moved.size()) + " objects: ";
    for (std::size_t i = 0; i < kInFull; ++i) line += moved[i] + "; ";
    return {line + "and " + std::to_string(moved.size() - kInFull) + " more, which --report lists"};
}

void require_light(const Work& work) {
    if (const auto fault = uncountable_light(work.mesh))
        throw InputError(work.scene.file + ": " + *fault);
    if (emits_light(work.mesh)) return;
    throw InputError(work.scene.file + ": nothing emits light, so there is nothing to solve" +
                     (work.scene.lights_not_taken > 0
                          ? ": lights of KHR_lights_punctual are not taken, emissive faces are"
                          : ""));
}

std::string with_fewer_lights(const Mesh& mesh, Lights lights) {
    const auto count = group_lights(mesh, lights).names.size();
    const auto by_material = group_lights(mesh, Lights::by_material).names.size();
    if (by_material >= count) return "; emitters of objects of one name are one light";
    return "; --lights by-material tells " + std::to_string(by_material) + " instead of " +
           std::to_string(count) + " lights apart";
}

void require_few_bands(const Work& work, const SolveOptions& options,
                       const mp1map::DeviceSummary& device) {
    const auto& parts = options.solver.parts;
    const auto bands = plan_bands(work.mesh, parts).solved.size();
    const auto most = most_bands(device, mp1map::fit_pe_array(device, options.solver.pe_array));
    if (bands <= most) return;
    throw InputError(
        work.scene.file + ": " + std::to_string(bands) + " bands to solve at once, " + device.name +
        " takes " + std::to_string(most) +
        (parts.lights == Lights::together ? "" : with_fewer_lights(work.mesh, parts.lights)));
}

MemoryEstimate checked_memory(const Work& work, const SolveOptions& options,
                              const mp1map::DeviceSummary& device) {
    auto memory = estimate_memory(work.mesh, work.layout, options, device, work.prepare_bytes);
    require_memory(work.scene.file, memory, options, device);
    return memory;
}

/// Where the options ask for none, nothing.
SolveIdentity checked_identity(const Work& work, const SolveOptions& options,
                               const mp1map::DeviceSummary& device) {
    if (!options.checkpoint && !options.resume) return {};
    auto solve = identity_of(options, work.scene, work.mesh, device);
    if (!options.resume) return solve;
    require_same_solve(*options.resume, *work.checkpoint, solve, options.solver.tolerance,
                       options.solver.max_shots);
    if (const auto warning = doubt(*options.resume, *work.checkpoint, solve))
        print_warnings(std::cerr, {*warning});
    return solve;
}

/// Returns how many shots there were before.
std::uint64_t resume(ProgressiveSolver& solver, const Work& work, const SolveOptions& options) {
    if (!options.resume) return 0;
    try {
        solver.resume(work.checkpoint->state);
    } catch (const InputError& fault) {
        throw InputError(options.resume->string() + ": " + fault.what());
    }
    const auto shots = work.checkpoint->state.shots;
    if (!options.quiet)
        std::cerr << printable(options.resume->string()) << ": goes on after "
                  << counted(shots, "shot") << '\n';
    return shots;
}

Stop shoot(ProgressiveSolver& solver, const Work& work, const SolveOptions& options,
           const Interrupts& interrupts, Checkpoints& checkpoints, ShotClock& shot_clock,
           std::vector<std::string>& warnings) {
    Snapshots snapshots(options.snapshots, options.resume ? work.checkpoint->state.shots : 0);
    ProgressDisplay display(progress_style(options.quiet, options.no_progress),
                            options.solver.tolerance);
    const auto warn = [&](const std::string& warning) {
        display.clear();
        print_warnings(std::cerr, {warning});
        warnings.push_back(warning);
    };
    bool has_warned = false;
    return solver.solve([&](const Progress& progress) {
        shot_clock.note(progress);
        if (const auto warning = checkpoints.note(progress, solver)) warn(*warning);
        display.show(progress.shots, progress.unshot_fraction);
        if (snapshots.due(progress)) {
            const auto fault = write_interim_picture(options, work.scene, work.cameras, work.mesh,
                                                     work.layout, solver.solution());
            if (fault && !std::exchange(has_warned, true))
                warn(*fault + "; the solve goes on, and the next snapshot is tried");
        }
        return !interrupts.requested();
    });
}

/// Of a solve that is short, or partly done, or told to nobody, nothing.
std::optional<Forecast> foretold(ProgressiveSolver& solver, const SolveOptions& options,
                                 const Interrupts& interrupts) {
    constexpr double kShort = 40;  // s; by looks one at a time, which take three times as long
    if (options.resume || (options.quiet && !options.report)) return {};
    const Stopwatch foretelling;
    const auto forecast = solver.forecast(kShort, [&] {
        return !interrupts.requested() && foretelling.seconds() < options.solver.time_limit;
    });
    if (forecast && !options.quiet) std::cerr << "time " << time_text(*forecast) << '\n';
    return forecast;
}

Outcome solve_once(const Work& work, const SolveOptions& options, const mp1map::Device& device,
                   const Interrupts& interrupts) {
    Checkpoints checkpoints(options, checked_identity(work, options, device.summary()));
    if (const auto warning = checkpoints.warning(); warning && !options.quiet)
        print_warnings(std::cerr, {*warning});
    ProgressiveSolver solver(work.mesh, options.solver, device);
    if (!options.quiet) {
        print_plan(std::cerr, options, work.mesh, device.summary(), solver.pe_array());
        std::cerr << "memory " << memory_text(work.memory) << '\n';
    }
    Outcome outcome;
    outcome.forecast = foretold(solver, options, interrupts);
    outcome.resumed_shots = resume(solver, work, options);
    const Stopwatch solving;
    ShotClock shot_clock(outcome.resumed_shots);
    outcome.stop =
        shoot(solver, work, options, interrupts, checkpoints, shot_clock, outcome.warnings);
    outcome.seconds.solve = solving.seconds();
    outcome.checkpoint_fault = checkpoints.write(solver);
    outcome.solution = solver.solution();
    outcome.closure = solver.closure();
    outcome.repeated_shots = solver.repeated_shots();
    outcome.accuracy = {options.solver.resolution, options.solver.shooter_samples,
                        options.solver.sampling_error};
    outcome.seconds.build_kernels = solver.build_seconds();
    outcome.seconds.per_kernel = solver.kernel_seconds();
    outcome.seconds.per_shot_median = shot_clock.median();
    outcome.device = device.summary();
    outcome.pe_array = solver.pe_array();
    outcome.device_bytes = solver.device_bytes();
    return outcome;
}

/// What the difference to `other` says of the error of `outcome`.
void note_error(const Work& work, const Outcome& other, Outcome& outcome) {
    outcome.error = {relative_rms_difference(work.mesh, other.solution, outcome.solution) +
                         missing_light(outcome.solution),
                     0, other.accuracy, difference(other.solution, outcome.solution)};
    for (const auto& band : outcome.error->by_patch.irradiance)
        outcome.error->largest =
            std::max(outcome.error->largest, *std::max_element(band.begin(), band.end()));
    outcome.seconds.solve += other.seconds.solve;
}

/// What several solutions of one command share.
struct Solving {
    const Work& work;
    const mp1map::Device& device;
    const Interrupts& interrupts;
    Stopwatch stopwatch = {};  ///< the time limit is that of all of them and of the gather
};

Outcome solve_with(const Solving& solving, SolveOptions options, const SolverSettings& solver) {
    options.solver = solver;
    options.solver.time_limit -= solving.stopwatch.seconds();
    return solve_once(solving.work, options, solving.device, solving.interrupts);
}

SolveOptions without_interim_files(SolveOptions options) {
    options.snapshots = {};
    options.checkpoint = options.resume = {};
    options.solver.stop_every.clear();
    return options;
}

std::vector<LightmapFile> files_of(const Work& work, const SolveOptions& options,
                                   const std::vector<std::size_t>& covered) {
    if (!options.report) return {};
    std::vector<LightmapFile> files;
    for (auto& contents : atlas_contents(work.scene, work.mesh, work.layout)) {
        const auto atlas = static_cast<std::uint32_t>(files.size());
        files.push_back({atlas_file(options.output, atlas), std::move(contents), covered[atlas]});
    }
    return files;
}

/// Throws what the first that cannot be written throws, once all were tried.
void write_results(const Work& work, const SolveOptions& options, Outcome& outcome) {
    std::exception_ptr fault;
    const auto attempt = [&](const auto& write) {
        try {
            write();
        } catch (const std::exception&) {
            if (!fault) fault = std::current_exception();
        }
    };
    const bool layer = options.estimate_error && outcome.error;
    const auto* const gathered = outcome.gathered ? &*outcome.gathered : nullptr;
    attempt([&] {
        const auto covered = write_picture(options, work.mesh, work.layout, outcome.solution,
                                           layer ? &outcome.error->by_patch : nullptr, gathered);
        outcome.lightmaps = files_of(work, options, covered);
    });
    attempt([&] {
        write_solved_scene(options, work.scene, work.cameras, work.mesh, work.layout,
                           outcome.solution, gathered);
    });
    attempt([&] {
        if (options.faces) write_faces(*options.faces, work.scene, work.mesh, outcome.solution);
    });
    if (fault) std::rethrow_exception(fault);
}

/// What `outcome` was solved with, for who reads of it.
void take_accuracy(const Outcome& outcome, SolverSettings& settings) {
    settings.resolution = outcome.accuracy.resolution;
    settings.shooter_samples = outcome.accuracy.shooter_samples;
    settings.sampling_error = outcome.accuracy.sampling_error;
}

/// What `call` returns; where it fails, what a solve gave before is written: it took longer.
template <class Call>
auto or_saved(const Work& work, SolveOptions options, Outcome& outcome, const Call& call) try {
    return call();
} catch (const std::exception&) {
    take_accuracy(outcome, options.solver);
    write_results(work, options, outcome);
    throw;
}

/// An error is known only of solutions that both came to their end.
Outcome solve_and_estimate(const Solving& solving, const SolveOptions& options) {
    auto outcome = solve_with(solving, options, options.solver);
    if (!options.estimate_error || outcome.stop != Stop::converged) return outcome;
    const auto plain = without_interim_files(options);
    const auto other = or_saved(solving.work, options, outcome, [&] {
        return solve_with(solving, plain, for_comparison(plain.solver));
    });
    if (other.stop == Stop::converged) note_error(solving.work, other, outcome);
    return outcome;
}

/// Steps of the dial until one differs from the step before by no more than the target. The last
/// that came to its end is kept.
Outcome solve_to_target(const Solving& solving, const SolveOptions& options) {
    const auto plain = without_interim_files(options);
    double tolerance = plain.solver.tolerance;
    const auto solve_at = [&](unsigned step) {
        SolverSettings solver = plain.solver;
        solver.tolerance = tolerance;
        solver.shooter_samples = accuracy_at(step).shooter_samples;
        set_accuracy(solver, accuracy_at(step));
        SolveOptions own = plain;
        own.solver = solver;
        checked_memory(solving.work, own, solving.device.summary());
        auto outcome = solve_with(solving, plain, solver);
        // Of lights that shine out of the scene, what is left is more of what arrives.
        const double missing = missing_light(outcome.solution);
        if (missing > *options.target_error / 4)
            tolerance *= 0.9 * *options.target_error / (4 * missing);
        return outcome;
    };
    unsigned step = first_step(*options.target_error);
    auto coarser = solve_at(step - 1);
    while (coarser.stop == Stop::converged) {
        auto outcome = or_saved(solving.work, plain, coarser, [&] { return solve_at(step); });
        if (outcome.stop != Stop::converged) {
            coarser.stop = outcome.stop;
            break;
        }
        note_error(solving.work, coarser, outcome);
        if (outcome.error->relative_rms <= *options.target_error || step == kFinestStep)
            return outcome;
        coarser = std::move(outcome);
        ++step;
    }
    return coarser;
}

/// Solutions of the dial's coarsest step tell where elements and patches are to be split. False
/// where one did not come to its end.
bool split_where_light_varies(Work& work, const Solving& solving, const SolveOptions& options) {
    constexpr double kBound = 0.02, kShooterBound = 0.01, kTolerance = 1e-2;
    SolveOptions pilot = without_interim_files(options);
    pilot.quiet = true;
    pilot.solver.parts = {};
    pilot.solver.count_shots = false;
    pilot.solver.resolution = pilot.solver.shooter_samples = 0;
    pilot.solver.sampling_error = 0;
    pilot.solver.max_shots = SolverSettings{}.max_shots;
    pilot.solver.tolerance = std::max(pilot.solver.tolerance, kTolerance);
    set_accuracy(pilot.solver, accuracy_at(0));
    for (std::uint32_t level = 0; level < options.mesh.split_levels; ++level) {
        const auto outcome = solve_with(solving, pilot, pilot.solver);
        if (outcome.stop != Stop::converged) return false;
        const Splits splits{
            find_splits(work.mesh, outcome.solution, options.mesh.split_levels, kBound),
            find_shooter_splits(work.mesh, outcome.solution, kShooterBound)};
        Mesh finer = split_mesh(work.scene, options.mesh, work.mesh, splits);
        for (std::size_t i = 0; i < finer.surfaces.size(); ++i)
            finer.surfaces[i].has_chart = work.mesh.surfaces[i].has_chart;
        if (finer.patches.size() == work.mesh.patches.size() &&
            finer.shooter_count() == work.mesh.shooter_count())
            return true;
        work.mesh = std::move(finer);
        work.memory = checked_memory(work, options, solving.device.summary());
    }
    return true;
}

std::optional<GatheredLightmaps> gathered_or_saved(const Solving& solving,
                                                   const SolveOptions& options, Outcome& outcome) {
    const Work& work = solving.work;
    const auto go_on = [&] {
        return !solving.interrupts.requested() &&
               solving.stopwatch.seconds() < options.solver.time_limit;
    };
    if (!go_on()) return {};
    return or_saved(work, options, outcome, [&] {
        return gather_lightmaps(options, work.mesh, work.layout, outcome.solution, solving.device,
                                go_on);
    });
}

void warn_of_missed_target(const SolveOptions& options, Outcome& outcome) {
    if (!options.target_error ||
        (outcome.error && outcome.error->relative_rms <= *options.target_error))
        return;
    outcome.warnings.push_back("--target-error " + number_text(*options.target_error) +
                               (outcome.error ? ": not reached" : ": stopped before it was known"));
    print_warnings(std::cerr, {outcome.warnings.back()});
}

void warn_of_missing_error(const SolveOptions& options, Outcome& outcome) {
    if (!options.estimate_error || options.target_error || outcome.error) return;
    outcome.warnings.push_back("--estimate-error: stopped before it was known");
    print_warnings(std::cerr, {outcome.warnings.back()});
}

/// What follows tells of the picture as it is.
void give_up_gather(SolveOptions& options, const Interrupts& interrupts, Outcome& outcome) {
    options.gather.reset();
    outcome.warnings.push_back("--gather: stopped by " +
                               (interrupts.requested()
                                    ? std::string("a signal")
                                    : "--time-limit " + number_text(options.solver.time_limit)) +
                               "; the lightmap is that of the patches");
    print_warnings(std::cerr, {outcome.warnings.back()});
}

void gather(const Solving& solving, SolveOptions& options, Outcome& outcome) {
    if (!options.gather) return;
    const Stopwatch gathering;
    outcome.gathered = gathered_or_saved(solving, options, outcome);
    outcome.seconds.gather = gathering.seconds();
    if (!outcome.gathered) give_up_gather(options, solving.interrupts, outcome);
}

void warn_of_faint_light(const SolveOptions& options, Outcome& outcome) {
    const auto faint = faint_bands(options, outcome.solution);
    outcome.warnings.insert(outcome.warnings.end(), faint.begin(), faint.end());
    print_warnings(std::cerr, faint);
}

/// However it was stopped: who opens the picture later does not see why it is dark.
void warn_of_missing_light(const SolveOptions& options, Outcome& outcome) {
    constexpr double kFaultless = 0.1;
    const double unshot = outcome.solution.unshot_fraction;
    if (unshot <= kFaultless) return;
    outcome.warnings.push_back(options.output.string() + ": " + percent_text(unshot) +
                               " of the light is still to be shot, the picture is darker than it "
                               "will be");
    print_warnings(std::cerr, {outcome.warnings.back()});
}

/// Exit code. What is there from earlier is better than what could be written.
int leave_files(const SolveOptions& options, const Interrupts& interrupts, const char* before) {
    const auto fault =
        options.output.string() + ": stopped before " + before + "; nothing is written";
    if (!interrupts.requested()) throw InputError(fault);
    std::cerr << printable(fault) << '\n';
    return kInterrupted;
}

bool would_replace_by_nothing(const SolveOptions& options, const Outcome& outcome) {
    const bool stopped = outcome.stop == Stop::interrupted || outcome.stop == Stop::time_limit;
    std::error_code ignored;
    return stopped && outcome.solution.shots == 0 &&
           std::ranges::any_of(output_files(options), [&](const auto& file) {
               return std::filesystem::exists(file, ignored);
           });
}

int solve(SolveOptions options) {
    const Stopwatch total;
    auto work = prepare(options);
    print_warnings(std::cerr, warnings_of(work.scene, work.mesh));
    print_warnings(std::cerr, moved_in_short(work.layout.moved));
    require_light(work);
    check_channels(options, work.mesh);
    const double preparing = total.seconds();
    const auto device = mp1map::Device::open(options.device, options.compute_units);
    require_few_bands(work, options, device.summary());
    work.prepare_bytes = peak_memory_bytes();
    work.memory = checked_memory(work, options, device.summary());

    const Interrupts interrupts;
    const Solving solving{work, device, interrupts};
    if (!split_where_light_varies(work, solving, options))
        return leave_files(options, interrupts, "--split was done");
    auto outcome = options.target_error ? solve_to_target(solving, options)
                                        : solve_and_estimate(solving, options);
    if (would_replace_by_nothing(options, outcome))
        return leave_files(options, interrupts, "the first shot");
    take_accuracy(outcome, options.solver);
    outcome.memory = work.memory;
    outcome.seconds.prepare = preparing;
    auto doubts = warnings_of(work.scene, work.mesh);
    doubts.insert(doubts.end(), work.layout.moved.begin(), work.layout.moved.end());
    outcome.warnings.insert(outcome.warnings.begin(), doubts.begin(), doubts.end());
    warn_of_missed_target(options, outcome);
    warn_of_missing_error(options, outcome);
    warn_of_faint_light(options, outcome);
    warn_of_missing_light(options, outcome);
    gather(solving, options, outcome);
    const Stopwatch writing;
    write_results(work, options, outcome);
    outcome.outputs = output_files(options);
    outcome.seconds.lightmap = writing.seconds();
    outcome.seconds.total = total.seconds();
    if (options.report) write_report(*options.report, options, work.mesh, outcome);
    if (!options.quiet) print_summary(std::cerr, options, outcome);
    if (outcome.checkpoint_fault) throw OutputError(*outcome.checkpoint_fault);
    return interrupts.requested() ? kInterrupted : kDone;
}

void reject_with_target_error(const SolveOptions& options) {
    if (options.snapshots.shots > 0 || options.snapshots.seconds > 0)
        reject_both("--snapshot-every", "--target-error");
    if (options.checkpoint) reject_both("--checkpoint", "--target-error");
    if (options.resume) reject_both("--resume", "--target-error");
}

}  // namespace

void add_solve(CLI::App& app, Command& chosen) {
    auto& command = add_command(app, "solve", "a scene to its lightmap");
    const auto options = std::make_shared<SolveOptions>();
    add_solve_options(command, *options);
    on_chosen(command, [&chosen, options] {
        const auto checkpoint_shots = options->checkpoint ? options->checkpoint_every.shots : 0;
        options->solver.stop_every = {options->snapshots.shots, checkpoint_shots};
        options->solver.timed = options->verbose || options->report.has_value();
        if (options->target_error) reject_with_target_error(*options);
        if (options->target_error)
            options->solver.tolerance =
                std::min(options->solver.tolerance, *options->target_error / 4);
        else
            set_accuracy(options->solver, accuracy_at(static_cast<unsigned>(options->quality)));
        chosen = [options] { return solve(*options); };
    });
}

}  // namespace hemirad
