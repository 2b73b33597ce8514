#include "view/lit_scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "errors.h"
#include "lightmap/read_exr.h"
#include "scene/gltf_file.h"
#include "scene/read_scene.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
    throw InputError(printable(file.filename().string()) + ": " + reason);
}

/// asset.extras.hemirad.exr
std::string exr_named_in(const Json& gltf) {
    const Json* at = &gltf;
    for (const char* key : {"asset", "extras", "hemirad", "exr"}) {
        if (!at->is_object() || !at->contains(key)) return "";
        at = &(*at)[key];
    }
    return at->is_string() ? at->get<std::string>() : "";
}

fs::path exr_of(const fs::path& gltf) {
    const InputFile file = read_input_file(gltf);
    const std::string name = exr_named_in(load_gltf(file).json);
    if (name.empty()) fail(gltf, "names no lightmap in asset.extras.hemirad.exr; --lightmap does");
    // A reference in glTF would be a URI; this is a file's name.
    const fs::path relative(name);
    if (relative.is_absolute() || *relative.lexically_normal().begin() == "..")
        fail(gltf, "its lightmap \"" + printable(name) +
                       "\" is not in its folder; --lightmap says which to take");
    return gltf.parent_path() / relative;
}

void require_uvs(const fs::path& gltf, const Scene& scene) {
    if (std::ranges::all_of(scene.faces, [](const Face& face) {
            return face.vertices.size() == 3 && face.lightmap_uvs.size() == 3;
        }))
        return;
    fail(gltf, "is not solved; hemirad solve SCENE -o SOLVED.glb makes a scene with its light");
}

struct Named {
    fs::path file;
    std::uint64_t shots;
};

std::vector<Named> snapshots_beside(const fs::path& exr) {
    std::vector<Named> found;
    const std::string prefix = exr.stem().string() + "-";
    const fs::path folder = exr.has_parent_path() ? exr.parent_path() : ".";
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() != exr.extension() || !stem.starts_with(prefix)) continue;
        const char *first = stem.data() + prefix.size(), *last = stem.data() + stem.size();
        std::uint64_t shots = 0;
        const auto [rest, fault] = std::from_chars(first, last, shots);
        if (fault == std::errc() && rest == last) found.push_back({entry.path(), shots});
    }
    std::ranges::sort(found, {}, &Named::shots);
    return found;
}

std::string text_in(const ExrLightmap& exr, const std::string& name) {
    const auto found = exr.attributes.find(name);
    return found == exr.attributes.end() ? "" : found->second;
}

}  // namespace

LitScene read_lit_scene(const fs::path& gltf, const std::optional<fs::path>& exr) {
    LitScene lit;
    lit.scene = read_scene(gltf);
    require_uvs(gltf, lit.scene);
    lit.cameras = read_cameras(gltf);
    lit.exr = exr ? *exr : exr_of(gltf);
    ExrLightmap read = read_exr(lit.exr, lit.scene.bands);
    lit.lightmap = std::move(read.lightmap);
    lit.settings = text_in(read, "settings");
    if (text_in(read, "quantity") == "radiosity") lit.quantity = Quantity::radiosity;
    return lit;
}

fs::path snapshot_file(const fs::path& exr, std::uint64_t shots) {
    fs::path file = exr;
    file.replace_filename(exr.stem().string() + "-" + std::to_string(shots) +
                          exr.extension().string());
    return file;
}

std::vector<Snapshot> read_snapshots(const LitScene& scene) {
    std::vector<Snapshot> snapshots;
    for (const auto& [file, shots] : snapshots_beside(scene.exr)) try {
            ExrLightmap read = read_exr(file, scene.scene.bands);
            if (read.lightmap.width == scene.lightmap.width &&
                read.lightmap.height == scene.lightmap.height &&
                text_in(read, "settings") == scene.settings)
                snapshots.push_back({shots, std::move(read.lightmap)});
        } catch (const InputError&) {
            continue;
        }
    return snapshots;
}

}  // namespace hemirad
