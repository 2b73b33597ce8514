#include "cli/summary.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "cli/text.h"
#include "scene/bounds.h"
#include "scene/printable.h"
#include "solver/bands.h"

namespace hemirad {
namespace {

template <typename... Values>
void print(std::ostream& out, const char* format, Values... values) {
    std::array<char, 256> line{};
    std::snprintf(line.data(), line.size(), format, values...);
    out << line.data();
}

std::string ending(const SolveOptions& options, const Outcome& outcome) {
    switch (outcome.stop) {
        case Stop::converged:
            return "converged, below --tolerance " + number_text(options.solver.tolerance);
        case Stop::max_shots:
            return "stopped by --max-shots " + std::to_string(options.solver.max_shots);
        case Stop::time_limit:
            return "stopped by --time-limit " + number_text(options.solver.time_limit);
        case Stop::interrupted:
            return "interrupted; the picture so far is valid";
    }
    return {};
}

std::string lights_of(const SolveOptions& options, const Mesh& mesh) {
    const auto lights = options.solver.parts.lights;
    if (lights == Lights::together) return "";
    return counted(group_lights(mesh, lights).names.size(), "light") + " apart, " +
           counted(plan_bands(mesh, options.solver.parts).solved.size(), "band") + " solved\n";
}

std::string size_of(const Mesh& mesh) {
    const auto patches = counted(mesh.shooter_count(), "patch", "patches");
    if (mesh.shooters.empty()) return patches;
    return patches + " in " + counted(mesh.patches.size(), "element");
}

void print_ledger(std::ostream& out, const Solution& solution) {
    print(out, "%-8s %12s %12s %12s %12s %10s\n", "band", "emitted W", "absorbed W", "escaped W",
          "unshot W", "residual");
    for (std::size_t band = 0; band < solution.bands.size(); ++band) {
        const auto& ledger = solution.ledger[band];
        print(out, "%-8s %12.6g %12.6g %12.6g %12.6g %10.2g\n",
              printable(solution.bands[band]).c_str(), ledger.emitted, ledger.absorbed,
              ledger.escaped, ledger.unshot, ledger.residual());
    }
}

void print_kernels(std::ostream& out, const Outcome& outcome) {
    for (const auto& [kernel, spent] : outcome.seconds.per_kernel)
        print(out, "%-24s %10.3f s %10llu launches\n", kernel.c_str(), spent.first,
              static_cast<unsigned long long>(spent.second));
}

}  // namespace

std::vector<std::string> warnings_of(const Scene& scene, const Mesh& mesh) {
    auto warnings = scene.warnings;
    std::set<std::string> told(warnings.begin(), warnings.end());
    for (const auto& warning : mesh.warnings)
        if (told.insert(warning).second) warnings.push_back(warning);
    return warnings;
}

void print_warnings(std::ostream& out, const std::vector<std::string>& warnings) {
    for (const auto& warning : warnings) out << "warning: " << printable(warning) << '\n';
}

std::string extent_text(const Mesh& mesh) {
    const Bounds bounds = bounds_of(mesh.vertices);
    const glm::dvec3 size = bounds.most - bounds.least;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%.4g x %.4g x %.4g m", size.x, size.y, size.z);
    return text.data();
}

std::string time_text(const Forecast& forecast) {
    const auto whole = [](double count) { return std::llround(count); };
    return "about " + duration_text(forecast.seconds) + " for " +
           counted(static_cast<std::uint64_t>(whole(forecast.shots)), "shot") + ", " +
           std::to_string(whole(forecast.looks)) + " of them with a look";
}

void print_plan(std::ostream& out, const SolveOptions& options, const Mesh& mesh,
                const mp1map::DeviceSummary& device, const mp1map::PeArray& array) {
    out << printable(options.scene.filename().string()) << ": " << size_of(mesh) << " on "
        << counted(mesh.surfaces.size(), "surface") << ", " << (mesh.closed ? "closed" : "open")
        << ", " << extent_text(mesh) << '\n'
        << printable(device.name) << ": " << counted(device.compute_units, "compute unit") << ", "
        << array.description() << '\n'
        << options.solver.resolution << "^2 proxels, "
        << (options.solver.shooter_samples == 0
                ? "hemispheres a patch by nearness"
                : counted(std::uint64_t{options.solver.shooter_samples} *
                              options.solver.shooter_samples,
                          "hemisphere") +
                      " a patch")
        << ", form factors " << name_of(options.solver.form_factor) << '\n'
        << lights_of(options, mesh);
}

void print_summary(std::ostream& out, const SolveOptions& options, const Outcome& outcome) {
    const auto& solution = outcome.solution;
    out << ending(options, outcome) << ": " << counted(solution.shots, "shot") << " in "
        << duration_text(outcome.seconds.solve);
    print(out, ", unshot %.3g %%\n", 100 * solution.unshot_fraction);
    print_ledger(out, solution);
    if (outcome.error)
        print(out,
              "error about %.2g or less of the mean irradiance (RMS over these patches), largest "
              "%.3g "
              "W/m^2\n",
              outcome.error->relative_rms, outcome.error->largest);
    if (outcome.gathered)
        out << "light gathered at " << counted(outcome.gathered->gathered(), "texel")
            << ", interpolated at " << outcome.gathered->interpolated() << ", in "
            << duration_text(outcome.gathered->seconds) << '\n';
    print(out, "closure %.9g to %.9g, %s in all\n", outcome.closure.least, outcome.closure.most,
          duration_text(outcome.seconds.total).c_str());
    if (options.verbose) {
        out << "device memory " << bytes_text(outcome.device_bytes) << ", kernels built in "
            << duration_text(outcome.seconds.build_kernels) << '\n';
        print_kernels(out, outcome);
    }
    if (options.checkpoint && !outcome.checkpoint_fault)
        out << "wrote " << printable(options.checkpoint->string()) << '\n';
    for (const auto& file : outcome.outputs) out << "wrote " << printable(file.string()) << '\n';
}

}  // namespace hemirad
