#include "cli/solve.h"

#include <chrono>
#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/interrupts.h"
#include "cli/memory.h"
#include "cli/outcome.h"
#include "cli/outputs.h"
#include "cli/progress_display.h"
#include "cli/report.h"
#include "cli/shot_clock.h"
#include "cli/snapshots.h"
#include "cli/solve_options.h"
#include "cli/summary.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/write_faces.h"
#include "scene/read_scene.h"
#include "solver/bands.h"

namespace hemirad {
namespace {

class Stopwatch {
  public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Everything known before the first shot. The mesh is the scene's; both are needed to the end.
struct Work {
    Scene scene;
    Mesh mesh;
    ChartLayout layout;
};

Work prepare(SolveOptions& options) {
    if (options.output.empty()) options.output = options.scene.stem().string() + ".exr";
    check_outputs(options);
    Work work;
    work.scene = read_scene(options.scene);
    if (options.mesh.patch_size == 0) options.mesh.patch_size = default_patch_size(work.scene);
    work.mesh = build_mesh(work.scene, options.mesh);
    work.layout = lay_out_charts(work.mesh, {.texel_size = options.texel_size});
    options.texel_size = work.layout.texel_size;
    return work;
}

void require_light(const Work& work) {
    for (std::size_t band = 0; band < work.mesh.bands.size(); ++band)
        if (emitted_flux(work.mesh, band) > 0) return;
    throw InputError(work.scene.file + ": nothing emits light, so there is nothing to solve");
}

void require_memory(const Work& work, const SolveOptions& options,
                    const mp1map::DeviceSummary& device) {
    const auto array = mp1map::fit_pe_array(device, options.solver.pe_array);
    const auto needed = device_bytes(work.mesh, options.solver.resolution, array);
    if (needed <= device.global_memory) return;
    throw InputError(work.scene.file + ": needs " + bytes_text(needed) + ", " + device.name +
                     " has " + bytes_text(device.global_memory) +
                     "; raise --patch-size or lower --resolution");
}

Stop shoot(ProgressiveSolver& solver, const Work& work, const SolveOptions& options,
           const Interrupts& interrupts, ShotClock& shot_clock) {
    Snapshots snapshots(options.snapshots);
    ProgressDisplay display(progress_style(options.quiet, options.no_progress),
                            options.solver.tolerance);
    return solver.solve([&](const Progress& progress) {
        shot_clock.note(progress);
        display.show(progress.shots, progress.unshot_fraction);
        if (snapshots.due(progress))
            write_picture(options, work.mesh, work.layout, solver.solution());
        return !interrupts.requested();
    });
}

void write_results(const Work& work, const SolveOptions& options, const Solution& solution) {
    write_picture(options, work.mesh, work.layout, solution);
    if (options.faces) write_faces(*options.faces, work.scene, work.mesh, solution);
}

Outcome outcome_of(ProgressiveSolver& solver, const Work& work, const mp1map::Device& device) {
    Outcome outcome;
    outcome.solution = solver.solution();
    outcome.closure = solver.closure();
    outcome.seconds.build_kernels = solver.build_seconds();
    outcome.seconds.per_kernel = solver.kernel_seconds();
    outcome.device = device.summary();
    outcome.pe_array = solver.pe_array();
    outcome.device_bytes = solver.device_bytes();
    outcome.warnings = warnings_of(work.scene, work.mesh);
    return outcome;
}

int solve(SolveOptions options) {
    const Stopwatch total;
    const auto work = prepare(options);
    print_warnings(std::cerr, warnings_of(work.scene, work.mesh));
    require_light(work);
    const auto device = mp1map::Device::open(options.device, options.compute_units);
    require_memory(work, options, device.summary());
    ProgressiveSolver solver(work.mesh, options.solver, device);
    if (!options.quiet)
        print_plan(std::cerr, options, work.mesh, device.summary(), solver.pe_array());

    const Interrupts interrupts;
    const Stopwatch solving;
    ShotClock shot_clock;
    const auto stop = shoot(solver, work, options, interrupts, shot_clock);
    const double solve_seconds = solving.seconds();

    auto outcome = outcome_of(solver, work, device);
    const Stopwatch writing;
    write_results(work, options, outcome.solution);
    outcome.stop = stop;
    outcome.outputs = output_files(options);
    outcome.seconds.solve = solve_seconds;
    outcome.seconds.per_shot_median = shot_clock.median();
    outcome.seconds.lightmap = writing.seconds();
    outcome.seconds.total = total.seconds();
    if (options.report) write_report(*options.report, options, work.mesh, outcome);
    if (!options.quiet) print_summary(std::cerr, options, outcome);
    return interrupts.requested() ? kInterrupted : kDone;
}

}  // namespace

void add_solve(CLI::App& app, Command& chosen) {
    auto* const command = app.add_subcommand("solve", "a scene to its lightmap");
    const auto options = std::make_shared<SolveOptions>();
    add_solve_options(*command, *options);
    command->callback([&chosen, options] {
        options->solver.stop_every = options->snapshots.shots;
        options->solver.timed = options->verbose || options->report.has_value();
        chosen = [options] { return solve(*options); };
    });
}

}  // namespace hemirad
