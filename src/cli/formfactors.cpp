#include "cli/formfactors.h"

#include <algorithm>
#include <iostream>
#include <memory>

#include "cli/exit_codes.h"
#include "cli/formfactors_options.h"
#include "cli/formfactors_report.h"
#include "cli/interrupts.h"
#include "cli/memory.h"
#include "cli/near_names.h"
#include "cli/outputs.h"
#include "cli/row_display.h"
#include "cli/summary.h"
#include "cli/text.h"
#include "errors.h"
#include "formfactor/enforce.h"
#include "formfactor/factor_surfaces.h"
#include "formfactor/write_factors.h"
#include "lightmap/atomic_file.h"
#include "scene/printable.h"
#include "scene/read_scene.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

/// The scene, and what of it is a row or a column.
struct Work {
    Scene scene;
    Mesh mesh;
    FactorSurfaces named;   ///< what names mean
    FactorSurfaces listed;  ///< the same, or patches
};

/// A surface's patches, or the one patch of `#index`.
void mark_patches(const Work& work, std::string_view option, const std::string& name,
                  std::vector<bool>& marked) {
    const bool is_patch = name.starts_with('#') &&
                          std::ranges::find(work.listed.names, name) != work.listed.names.end();
    const FactorSurfaces& surfaces = is_patch ? work.listed : work.named;
    const auto index = index_of_name(surfaces.names, work.scene.file, option, name);
    for (std::size_t patch = 0; patch < marked.size(); ++patch)
        if (surfaces.of_patch[patch] == index) marked[patch] = true;
}

/// Of each listed surface, whether one of the names means it.
std::vector<bool> meant(const Work& work, std::string_view option,
                        const std::vector<std::string>& names) {
    std::vector<bool> patches(work.mesh.patches.size(), false);
    for (const auto& name : names) mark_patches(work, option, name, patches);
    std::vector<bool> surfaces(work.listed.size(), false);
    for (std::size_t patch = 0; patch < patches.size(); ++patch)
        if (patches[patch]) surfaces[work.listed.of_patch[patch]] = true;
    return surfaces;
}

/// A blocker's back only blocks, too.
std::vector<std::string> with_backs(const Work& work, std::vector<std::string> names) {
    const auto& known = work.named.names;
    for (std::size_t i = 0, count = names.size(); i < count; ++i) {
        const std::string back = names[i] + " (back)";
        if (std::ranges::find(known, back) != known.end()) names.push_back(back);
    }
    return names;
}

void choose_blockers(Work& work, const FormFactorsOptions& options) {
    auto& listed = work.listed;
    const auto blocks = meant(work, "--blockers-only", with_backs(work, options.blockers_only));
    for (std::size_t s = 0; s < listed.size(); ++s)
        if (blocks[s]) listed.as_from[s] = listed.as_to[s] = false;
}

void choose_rows(Work& work, const FormFactorsOptions& options) {
    if (options.from.empty()) return;
    auto& listed = work.listed;
    const auto sends = meant(work, "--from", options.from);
    for (std::size_t s = 0; s < listed.size(); ++s) {
        if (sends[s] && !listed.as_to[s])
            throw InputError(work.scene.file + ": --from: \"" + printable(listed.names[s]) +
                             "\" only hides others");
        listed.as_from[s] = sends[s];
    }
}

void choose_columns(Work& work, const FormFactorsOptions& options) {
    if (options.receivers_only.empty()) return;
    auto& listed = work.listed;
    const auto receives = meant(work, "--receivers-only", options.receivers_only);
    for (std::size_t s = 0; s < listed.size(); ++s)
        listed.as_to[s] = listed.as_to[s] && receives[s];
}

Work prepare(const FormFactorsOptions& options) {
    Work work;
    work.scene = read_scene(options.scene);
    keep_side_files(work.scene, output_files(options));
    require_memory_for_mesh(work.scene, options.mesh, {}, options.device);
    work.mesh = build_mesh(work.scene, options.mesh);
    work.named = named_surfaces(work.scene, work.mesh);
    work.listed = options.per_patch ? single_patches(work.scene, work.mesh) : work.named;
    choose_blockers(work, options);
    choose_rows(work, options);
    choose_columns(work, options);
    if (std::ranges::find(work.listed.as_from, true) == work.listed.as_from.end())
        throw InputError(work.scene.file + ": every surface only hides others");
    return work;
}

/// To enforce the laws, rows of backs and blockers are needed, too.
std::vector<std::uint32_t> patches_to_compute(const Work& work, const FormFactorsOptions& options) {
    std::vector<std::uint32_t> patches;
    for (std::uint32_t patch = 0; patch < work.mesh.patches.size(); ++patch)
        if (options.enforce || work.listed.as_from[work.listed.of_patch[patch]])
            patches.push_back(patch);
    return patches.size() == work.mesh.patches.size() ? std::vector<std::uint32_t>{} : patches;
}

FormFactors compute(const Work& work, const FormFactorsOptions& options,
                    const mp1map::Device& device, const Interrupts& interrupts) {
    ViewFactorSettings settings = options.factors;
    settings.from = patches_to_compute(work, options);
    RowDisplay display(progress_style(options.quiet, options.no_progress));
    return view_factors(work.mesh, settings, device, [&](std::size_t done, std::size_t all) {
        display.show(done, all);
        return !interrupts.requested();
    });
}

LawErrors law_errors(const FormFactors& factors) {
    return {reciprocity_error(factors), closure_error(factors)};
}

void enforce_laws(FormFactors& factors, const Work& work, FactorsOutcome& outcome) {
    const Stopwatch enforcing;
    outcome.before = law_errors(factors);
    enforce(factors);
    outcome.after = law_errors(factors);
    outcome.enforce_seconds = enforcing.seconds();
    constexpr double kHeld = 1e-9;
    if (outcome.after->closure < kHeld) return;
    outcome.warnings.push_back(work.scene.file +
                               ": --enforce: no factors hold both laws where zeros stay zero");
    print_warnings(std::cerr, {outcome.warnings.back()});
}

FactorsOutcome outcome_of(const Work& work, const mp1map::Device& device,
                          const FormFactorsOptions& options) {
    FactorsOutcome outcome;
    outcome.patches = work.mesh.patches.size();
    outcome.surfaces = std::size_t(std::ranges::count(work.named.is_back, false));
    outcome.closed = work.mesh.closed;
    outcome.device = device.summary();
    outcome.pe_array = mp1map::fit_pe_array(device.summary(), options.factors.pe_array);
    outcome.warnings = warnings_of(work.scene, work.mesh);
    return outcome;
}

/// Of what is listed.
void measure(const FormFactors& factors, const Work& work, const FormFactorsOptions& options,
             FactorsOutcome& outcome) {
    outcome.rows = factors.rows.size();
    for (const auto& row : factors.rows) outcome.factors += row.size();
    outcome.row_sums = row_sums(factors);
    const auto [least, most] = std::ranges::minmax(factors.outside);
    outcome.outside = {least, most};
    if (options.from.empty() && options.receivers_only.empty())
        outcome.reciprocity = reciprocity_error(among_listed(factors, work.listed));
}

void write_factors(std::ostream& out, const FormFactors& factors, const Work& work,
                   const FormFactorsOptions& options) {
    if (options.format == FactorFormat::view3d) write_view3d(out, factors, work.listed);
    if (options.format == FactorFormat::view3d_sparse)
        write_view3d_sparse(out, factors, work.listed);
    if (options.format == FactorFormat::csv)
        write_factors_csv(out, factors, work.listed, !options.from.empty() && !options.per_patch);
}

void write_output(const FormFactors& factors, const Work& work, const FormFactorsOptions& options) {
    const auto write = [&](std::ostream& out) { write_factors(out, factors, work, options); };
    if (options.output)
        write_atomically(*options.output, write);
    else
        write(std::cout);
}

void print_plan(const Work& work, const FactorsOutcome& outcome) {
    std::cerr << printable(work.scene.file) << ": " << counted(outcome.patches, "patch", "patches")
              << " of " << counted(outcome.surfaces, "surface") << ", "
              << (outcome.closed ? "closed" : "open") << '\n'
              << printable(outcome.device.name) << ": "
              << counted(outcome.device.compute_units, "compute unit") << ", "
              << outcome.pe_array.description() << '\n';
}

int interrupted(const FormFactorsOptions& options) {
    if (!options.quiet) std::cerr << "interrupted: nothing is written\n";
    return kInterrupted;
}

int formfactors(const FormFactorsOptions& options) {
    const Stopwatch total;
    check_formfactors_options(options);
    const Work work = prepare(options);
    print_warnings(std::cerr, warnings_of(work.scene, work.mesh));
    const auto device = mp1map::Device::open(options.device, options.compute_units);
    auto outcome = outcome_of(work, device, options);
    if (!options.quiet) print_plan(work, outcome);

    const Interrupts interrupts;
    const Stopwatch computing;
    FormFactors factors = compute(work, options, device, interrupts);
    outcome.factor_seconds = computing.seconds();
    if (interrupts.requested()) return interrupted(options);
    if (options.enforce) enforce_laws(factors, work, outcome);
    if (interrupts.requested()) return interrupted(options);
    if (!options.per_patch) factors = gathered(factors, work.listed);
    measure(factors, work, options, outcome);
    write_output(factors, work, options);
    outcome.total_seconds = total.seconds();
    if (options.report) write_report(*options.report, options, outcome);
    if (!options.quiet) print_summary(std::cerr, outcome);
    return interrupts.requested() ? kInterrupted : kDone;
}

}  // namespace

void add_formfactors(CLI::App& app, Command& chosen) {
    auto& command = add_command(app, "formfactors", "view factors, light or no light");
    const auto options = std::make_shared<FormFactorsOptions>();
    add_formfactors_options(command, *options);
    on_chosen(command,
              [&chosen, options] { chosen = [options] { return formfactors(*options); }; });
}

}  // namespace hemirad
