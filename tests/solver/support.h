#pragma once

#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "reference/form_factor_matrix.h"
#include "reference/gauss_seidel.h"
#include "scene/mesh.h"
#include "scene/read_scene.h"
#include "scene/scenes_by_hand.h"
#include "solver/bands.h"
#include "solver/solver.h"
#include "support/pipeline.h"

/// Scenes, solves and single shots for the tests of the whole solver.
namespace hemirad::test {

inline Scene scene_named(const std::string& name) {
    return read_scene(std::filesystem::path(HEMI_SCENES) / name);
}

inline Mesh meshed(const Scene& scene, double patch_size,
                   Backfaces backfaces = Backfaces::automatic) {
    return build_mesh(scene,
                      {.patch_size = patch_size, .backfaces = backfaces, .max_reflectance = 0.995});
}

/// Room of 6 m x 2.5 m x 4 m with a lamp in its ceiling, and three closed solids: a crate on the
/// floor, a board above it, and a pillar. Three bands, none proportional to another.
inline Scene furnished_room() {
    Scene scene;
    scene.file = "room";
    scene.bands = {"R", "G", "B"};
    scene.objects = {"room", "lamp", "crate", "board", "pillar"};
    scene.materials = {{"plaster", {0.7, 0.65, 0.5}, {0, 0, 0}, false},
                       {"lamp", {0.5, 0.6, 0.7}, {10, 9, 7}, false},
                       {"wood", {0.5, 0.3, 0.1}, {0, 0, 0}, false},
                       {"paint", {0.1, 0.2, 0.6}, {0, 0, 0}, false}};
    for (const auto& face : room({0, 0, 0}, {6, 4, 2.5}))
        if (face[0].z != face[2].z || face[0].z == 0) add_face(scene, face);
    const auto ceiling = [&](double x0, double y0, double x1, double y1, std::uint32_t lamp) {
        add_face(scene, {{x0, y0, 2.5}, {x0, y1, 2.5}, {x1, y1, 2.5}, {x1, y0, 2.5}}, lamp, lamp);
    };
    const double xs[] = {0, 2.5, 3.5, 6}, ys[] = {0, 1.5, 2.5, 4};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            ceiling(xs[i], ys[j], xs[i + 1], ys[j + 1], i == 1 && j == 1 ? 1 : 0);
    for (const auto& face : solid_box({1, 1, 0}, {1.7, 1.9, 0.8})) add_face(scene, face, 2, 2);
    for (const auto& face : solid_box({0.8, 0.9, 1.1}, {2.1, 2.2, 1.15}))
        add_face(scene, face, 3, 3);
    for (const auto& face : solid_box({4.2, 2.3, 0}, {4.6, 2.7, 2.2})) add_face(scene, face, 2, 4);
    return scene;
}

/// Closed: a block on the floor, and a smaller one that hangs over its border, at angles in turns.
inline Scene room_with_turned_blocks(double turns) {
    Scene scene = furnished_room();
    scene.faces.resize(5 + 9);
    const auto add_block = [&](glm::dvec3 middle, glm::dvec3 half, double angle, int object) {
        const double c = std::cos(angle), s = std::sin(angle);
        for (auto face : solid_box(-half, half)) {
            for (auto& p : face) p = middle + glm::dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
            add_face(scene, face, 2, static_cast<std::uint32_t>(object));
        }
    };
    add_block({2.5, 1.9, 0.5}, {0.8, 0.5, 0.5}, 7 * turns, 2);
    add_block({3.1, 2.1, 1.2}, {0.6, 0.3, 0.2}, 11 * turns, 4);
    return scene;
}

inline Scene scaled(Scene scene, double factor) {
    for (auto& position : scene.positions) position *= factor;
    return scene;
}

inline Scene moved(Scene scene, const glm::dvec3& by) {
    for (auto& position : scene.positions) position += by;
    return scene;
}

inline glm::dmat3 random_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto direction = [&] {
        return glm::dvec3(normal(random), normal(random), normal(random));
    };
    const auto x = glm::normalize(direction());
    const auto y = glm::normalize(glm::cross(direction(), x));
    return {x, y, glm::cross(x, y)};
}

inline Scene rotated(Scene scene, const glm::dmat3& rotation) {
    for (auto& position : scene.positions) position = rotation * position;
    return scene;
}

inline constexpr auto kAnyShots = std::numeric_limits<std::uint64_t>::max();

inline SolverSettings settings(std::uint32_t resolution, double tolerance = 1e-3,
                               std::uint64_t max_shots = kAnyShots) {
    SolverSettings result;
    result.resolution = resolution;
    result.shooter_samples = 1;
    result.form_factor = FormFactorMode::count;
    result.tolerance = tolerance;
    result.max_shots = max_shots;
    return result;
}

inline bool go_on(const Progress&) { return true; }

inline Solution solution_of(const Mesh& mesh, const SolverSettings& settings) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, settings, device);
    solver.solve(go_on);
    return solver.solution();
}

/// Every patch of a mesh may shoot, whether or not it has the most flux.
class Shooters {
  public:
    Shooters(const Mesh& mesh, std::uint32_t resolution, std::uint32_t samples = 1,
             const mp1map::PeArrayRequest& request = {})
        : arrays_(patch_arrays(mesh)),
          resolution_(resolution),
          samples_(samples),
          device_(mp1map::Device::open("")),
          pipeline_(arrays_, even_light(arrays_), wanted(resolution, samples, request), device_) {
        pipeline_.init_plane();
    }

    std::uint32_t patch_count() const { return arrays_.patch_count; }
    std::uint32_t part_count() const { return samples_ * samples_; }
    std::uint64_t proxels_a_part() const { return disk_proxel_count(resolution_); }
    const PatchArrays& arrays() const { return arrays_; }
    ShotPipeline& pipeline() { return pipeline_; }

    /// What one hemisphere of `patch` sees: owned and escaped proxels.
    struct Count {
        std::uint64_t owned = 0, escaped = 0;
    };
    Count count(std::uint32_t patch, std::uint32_t part) {
        pipeline_.set_shooter(patch, part);
        project_hemisphere(pipeline_);
        const auto counts = pipeline_.proxel_counts();
        const auto owned =
            std::accumulate(counts.begin(), counts.begin() + arrays_.stride, std::uint64_t{0});
        const auto escaped = static_cast<std::uint64_t>(counts[arrays_.stride]);
        pipeline_.clear_counts();
        return {owned, escaped};
    }

    /// Proxels that each patch owns, over all hemispheres of `patch`.
    std::vector<std::int32_t> proxel_counts(std::uint32_t patch) {
        pipeline_.set_shooter(patch);
        for (std::uint32_t part = 0; part < part_count(); ++part) project_hemisphere(pipeline_);
        auto counts = pipeline_.proxel_counts();
        counts.resize(arrays_.patch_count);
        pipeline_.clear_counts();
        return counts;
    }

    /// The frame of a hemisphere as aim_hemisphere makes it, normalised coordinates.
    reference::Shooter frame(std::uint32_t patch, std::uint32_t part) {
        pipeline_.set_shooter(patch, part);
        pipeline_.aim_hemisphere();
        const auto shot = pipeline_.shot();
        const auto vector = [](const float* v) { return glm::dvec3(v[0], v[1], v[2]); };
        return {grid_point(shot.origin), vector(shot.normal), vector(shot.u_axis)};
    }

    /// F_ij as the device counts it.
    reference::FormFactorMatrix form_factor_matrix() {
        reference::FormFactorMatrix matrix(patch_count());
        const double proxels = static_cast<double>(pipeline_.disk_proxels() * part_count());
        for (std::uint32_t from = 0; from < patch_count(); ++from) {
            const auto counts = proxel_counts(from);
            for (std::uint32_t to = 0; to < patch_count(); ++to)
                matrix.at(from, to) = counts[to] / proxels;
        }
        return matrix;
    }

  private:
    static PipelineSettings wanted(std::uint32_t resolution, std::uint32_t samples,
                                   const mp1map::PeArrayRequest& request) {
        PipelineSettings result;
        result.resolution = resolution;
        result.shooter_samples = samples;
        result.pe_array = request;
        return result;
    }

    PatchArrays arrays_;
    std::uint32_t resolution_, samples_;
    mp1map::Device device_;
    ShotPipeline pipeline_;
};

inline std::vector<double> areas_of(const Mesh& mesh) {
    std::vector<double> areas;
    for (const auto& patch : mesh.patches) areas.push_back(mesh.area(patch));
    return areas;
}

/// The radiosity equation of a band by the full matrix (sec. 1.2).
inline reference::BandSolution full_matrix_solution(const Mesh& mesh,
                                                    const reference::FormFactorMatrix& matrix,
                                                    std::size_t band) {
    std::vector<double> reflectances, emitted;
    for (const auto& patch : mesh.patches) {
        reflectances.push_back(reflectance(mesh, patch, band));
        emitted.push_back(emitted_radiosity(mesh, patch, band));
    }
    return reference::solve(matrix, areas_of(mesh), reference::Band{reflectances, emitted});
}

/// Largest |a - b| / b; infinite where only b is 0.
inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i)
        if (a[i] != b[i]) largest = std::max(largest, std::abs(a[i] - b[i]) / std::abs(b[i]));
    return largest;
}

}  // namespace hemirad::test
