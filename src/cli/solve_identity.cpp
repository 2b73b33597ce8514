#include "cli/solve_identity.h"

#include <algorithm>
#include <string_view>
#include <type_traits>

#include "cli/mesh_options.h"
#include "cli/sha256.h"
#include "cli/text.h"
#include "solver/kernel_source.h"
#include "solver/shot_pipeline.h"

namespace hemirad {
namespace {

/// Lengths go first, so that nothing moves from one list to the next unseen.
class Fingerprint {
  public:
    template <class T>
    requires std::is_trivially_copyable_v<T> Fingerprint& of(const T& value) {
        static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, double> ||
                      std::is_same_v<T, glm::dvec3>);
        sum_.add(&value, sizeof(value));
        return *this;
    }
    Fingerprint& of(const std::string& text) {
        of(text.size());
        sum_.add(text);
        return *this;
    }
    template <class T>
    Fingerprint& of(const std::vector<T>& list) {
        of(list.size());
        for (const T& one : list) of(one);
        return *this;
    }
    Fingerprint& of(const Face& face) {
        return of(face.vertices).of(face.material).of(face.object);
    }
    Fingerprint& of(const Material& material) {
        return of(material.name)
            .of(material.reflectance)
            .of(material.emission)
            .of(material.double_sided);
    }
    Fingerprint& of(const Surface& surface) {
        return of(surface.object).of(surface.material).of(surface.is_back).of(surface.plane);
    }

    std::string digits() { return sum_.digits(); }

  private:
    Sha256 sum_;
};

std::string scene_fingerprint(const Scene& scene) {
    return Fingerprint()
        .of(scene.bands)
        .of(scene.positions)
        .of(scene.faces)
        .of(scene.materials)
        .of(scene.objects)
        .of(scene.obstructions)
        .of(scene.quantum)
        .digits();
}

std::string mesh_fingerprint(const Mesh& mesh) {
    return Fingerprint()
        .of(mesh.vertices)
        .of(mesh.patches)
        .of(mesh.shooters)
        .of(mesh.surfaces)
        .of(mesh.materials)
        .digits();
}

/// A source but for its `#line`s, which tell where its files lie.
std::string without_places(std::string_view source) {
    std::string text;
    while (!source.empty()) {
        const auto line = source.substr(0, source.find('\n'));
        source.remove_prefix(std::min(line.size() + 1, source.size()));
        if (!line.starts_with("#line ")) text.append(line).append("\n");
    }
    return text;
}

/// Of all there are: those that a mode does without are among the other's.
std::string kernels_fingerprint(const std::optional<std::filesystem::path>& folder) {
    Fingerprint fingerprint;
    for (const auto& name : kernel_names(FormFactorMode::analytic))
        fingerprint.of(without_places(kernel_source(name, folder)));
    return fingerprint.digits();
}

std::string or_word(double number, const char* word_for_zero) {
    return number == 0 ? word_for_zero : number_text(number);
}

std::vector<std::pair<std::string, std::string>> settings_of(const SolveOptions& options,
                                                             const Mesh& mesh) {
    const auto& solver = options.solver;
    const auto salvo =
        usable_salvo(solver.salvo, mesh.shooter_count(), mesh.patches.size(), solver.resolution);
    const bool tells_direct = solver.parts.direct || solver.parts.indirect;
    return {{"--form-factor", name_of(solver.form_factor)},
            {"--resolution", std::to_string(solver.resolution)},
            {"--shooter-samples",
             solver.shooter_samples == 0 ? "auto" : std::to_string(solver.shooter_samples)},
            {"--sampling-error", number_text(solver.sampling_error)},
            {"--patch-size", number_text(options.mesh.patch_size)},
            {"--element-size", or_word(options.mesh.element_size, "none")},
            {"--split", std::to_string(options.mesh.split_levels)},
            {"--backfaces", name_of(options.mesh.backfaces)},
            {"--max-reflectance", number_text(options.mesh.max_reflectance)},
            {"--weld", or_word(options.mesh.weld, "by the file")},
            {"--salvo", std::to_string(salvo)},
            {"--lights", name_of(solver.parts.lights)},
            {"--layers",
             std::string(tells_direct ? "direct or indirect" : "neither direct nor indirect") +
                 (solver.count_shots ? ", and shots" : "")},
            {"--evaluate", solver.variants.incremental ? "incremental" : "direct"},
            {"--distance", solver.variants.constant_distance ? "constant" : "true"}};
}

}  // namespace

SolveIdentity identity_of(const SolveOptions& options, const Scene& scene, const Mesh& mesh,
                          const mp1map::DeviceSummary& device) {
    return {HEMIRAD_VERSION,
            scene_fingerprint(scene),
            mesh_fingerprint(mesh),
            kernels_fingerprint(options.solver.kernels_dir),
            device.name,
            settings_of(options, mesh)};
}

}  // namespace hemirad
