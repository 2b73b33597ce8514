#include "cli/tradeoff_solves.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace hemirad {
namespace {

/// What is left unshot; well below the errors of form factors that are measured.
constexpr double kTolerance = 1e-4;

using Bands = std::vector<std::vector<double>>;

struct Differences {
    double rms = 0, largest = 0;
};

/// Of one band. Where no light arrives there is nothing to be relative to.
Differences differences(const std::vector<double>& areas, const std::vector<double>& values,
                        const std::vector<double>& truth) {
    double area = 0, flux = 0, squares = 0, largest = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (areas[i] == 0) continue;
        const double difference = values[i] - truth[i];
        area += areas[i];
        flux += areas[i] * truth[i];
        squares += areas[i] * difference * difference;
        largest = std::max(largest, std::abs(difference));
    }
    if (flux == 0) return {};
    const double mean = flux / area;
    return {std::sqrt(squares / area) / mean, largest / mean};
}

Differences differences(const std::vector<double>& areas, const Bands& values, const Bands& truth) {
    Differences all;
    for (std::size_t band = 0; band < truth.size(); ++band) {
        const auto one = differences(areas, values[band], truth[band]);
        all.rms += one.rms * one.rms / static_cast<double>(truth.size());
        all.largest = std::max(all.largest, one.largest);
    }
    all.rms = std::sqrt(all.rms);
    return all;
}

/// m^2; 0 for backs that only block.
std::vector<double> patch_areas(const Mesh& mesh) {
    std::vector<double> areas;
    for (const Patch& patch : mesh.patches)
        areas.push_back(mesh.surfaces[patch.surface].has_chart ? mesh.area(patch) : 0);
    return areas;
}

std::vector<double> face_areas(const Mesh& mesh) {
    std::vector<double> areas(mesh.face_count);
    for (const Fragment& fragment : mesh.fragments) areas[fragment.face] += fragment.area;
    return areas;
}

/// Means over the fronts of input polygons; 0 for dropped ones.
Bands face_means(const Mesh& mesh, const Bands& of_patches) {
    const auto areas = face_areas(mesh);
    Bands means;
    for (const auto& band : of_patches) {
        auto& mean = means.emplace_back(mesh.face_count);
        for (const Fragment& fragment : mesh.fragments)
            mean[fragment.face] += fragment.area / areas[fragment.face] * band[fragment.patch];
    }
    return means;
}

SolverSettings solver_settings(const SolvePoint& point) {
    SolverSettings settings;
    settings.resolution = point.resolution;
    settings.shooter_samples = point.shooter_samples;
    settings.form_factor =
        point.method == Method::analytic ? FormFactorMode::analytic : FormFactorMode::count;
    settings.tolerance = kTolerance;
    settings.variants.constant_distance = point.method == Method::constant_distance;
    return settings;
}

}  // namespace

Solves::Solves(const Scene& scene, const MeshSettings& finest_mesh, const SolvePoint& finest,
               const mp1map::Device& device, SolveProgress on_progress)
    : scene_(scene),
      finest_mesh_(finest_mesh),
      finest_(finest),
      device_(device),
      on_progress_(std::move(on_progress)) {}

Solves::Solved Solves::solve(const Mesh& mesh, const SolvePoint& point) {
    SolverSettings settings = solver_settings(point);
    settings.max_shots = 1;  // PoCL compiles a kernel when it is first launched
    ProgressiveSolver(mesh, settings, device_).solve(on_progress_);
    ProgressiveSolver solver(mesh, solver_settings(point), device_);
    const auto start = std::chrono::steady_clock::now();
    solver.solve(on_progress_);
    const auto passed = std::chrono::steady_clock::now() - start;
    const double proxels = static_cast<double>(disk_proxel_count(point.resolution));
    return {solver.solution(), std::chrono::duration<double>(passed).count(),
            proxels * point.shooter_samples * point.shooter_samples};
}

Solves::Level& Solves::level(double patch_scale) {
    for (Level& level : levels_)
        if (level.patch_scale == patch_scale) return level;
    MeshSettings settings = finest_mesh_;
    settings.patch_size *= patch_scale;
    Mesh mesh = build_mesh(scene_, settings);
    Solution finest = solve(mesh, finest_).solution;
    return levels_.emplace_back(Level{patch_scale, std::move(mesh), std::move(finest)});
}

SolveMeasurement Solves::measure(const SolvePoint& point) {
    const Level& finest = level(1);
    const Level& own = level(point.patch_scale);
    const Solved solved = solve(own.mesh, point);
    const auto& irradiance = solved.solution.irradiance;

    SolveMeasurement measurement;
    measurement.shots = solved.solution.shots;
    measurement.samples = static_cast<double>(measurement.shots) * solved.samples_a_shot;
    measurement.seconds = solved.seconds;
    const auto patches = differences(patch_areas(own.mesh), irradiance, own.finest.irradiance);
    const auto faces = differences(face_areas(finest.mesh), face_means(own.mesh, irradiance),
                                   face_means(finest.mesh, finest.finest.irradiance));
    measurement.errors = {patches.rms, patches.largest, faces.rms};
    return measurement;
}

}  // namespace hemirad
