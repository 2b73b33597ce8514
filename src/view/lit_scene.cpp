#include "view/lit_scene.h"

#include <algorithm>
#include <charconv>

#include "errors.h"
#include "lightmap/atlas_file.h"
#include "lightmap/read_exr.h"
#include "scene/gltf_file.h"
#include "scene/read_scene.h"
#include "scene/short_text.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& reason) {
    throw InputError(printable(file.filename().string()) + ": " + reason);
}

fs::path exr_of(const fs::path& gltf, const Json& json) {
    const Json::json_pointer at("/asset/extras/hemirad/exr");
    if (!json.contains(at) || !json[at].is_string() || json[at] == "")
        fail(gltf, "names no lightmap in asset.extras.hemirad.exr; --lightmap does");
    const auto name = json[at].get<std::string>();
    // A reference in glTF would be a URI; this is a file's name. Normal, so that no link in it is
    // left upwards.
    const fs::path relative = fs::path(name).lexically_normal();
    if (relative.is_absolute() || *relative.begin() == "..")
        fail(gltf, "its lightmap \"" + printable(name) +
                       "\" is not in its folder; --lightmap says which to take");
    return gltf.parent_path() / relative;
}

/// One where the file says nothing of atlases: another program's, with a lightmap from elsewhere.
std::size_t atlas_count_in(const Json& json, const fs::path& gltf) {
    const Json::json_pointer at("/asset/extras/hemirad/atlases");
    if (!json.contains(at)) return 1;
    const std::size_t textures = json.contains("textures") ? json["textures"].size() : 0;
    if (!json[at].is_number_unsigned() || json[at] < 1u || json[at] > textures)
        fail(gltf, "asset.extras.hemirad.atlases is no number of its textures");
    return json[at].get<std::size_t>();
}

/// By material; the first textures are the atlases.
std::vector<std::uint32_t> atlases_of(const Scene& scene, const Json& json, std::size_t count,
                                      const fs::path& gltf) {
    std::vector<std::uint32_t> atlas_of(scene.materials.size());
    for (std::size_t i = 0; i < atlas_of.size() && count > 1; ++i) {
        const std::string material = "materials/" + std::to_string(i);
        const Json::json_pointer at("/" + material + "/extensions/MOZ_lightmap/index");
        if (!json.contains(at) || !json[at].is_number_unsigned() || json[at] >= count)
            fail(gltf, material + ": its MOZ_lightmap is none of the atlases");
        atlas_of[i] = json[at].get<std::uint32_t>();
    }
    return atlas_of;
}

void require_uvs(const fs::path& gltf, const Scene& scene) {
    if (std::ranges::all_of(scene.faces, [](const Face& face) {
            return face.vertices.size() == 3 && face.lightmap_uvs.size() == 3;
        }))
        return;
    fail(gltf, "is not solved; hemirad solve SCENE -o SOLVED.glb makes a scene with its light");
}

struct ImageSize {
    std::uint32_t width = 0, height = 0;
};

/// Of the glTF's own picture of the lightmap; nothing where that is no PNG. PNG, sec. 5.2, 11.2.2.
std::optional<ImageSize> size_in_gltf(const GltfFile& gltf, std::uint32_t atlas) {
    constexpr std::string_view kBegin("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16);
    if (atlas >= gltf.model.textures.size() || gltf.model.textures[atlas].source < 0) return {};
    const auto source = static_cast<std::size_t>(gltf.model.textures[atlas].source);
    const tinygltf::Image& image = gltf.model.images[source];
    const std::string_view inlined(reinterpret_cast<const char*>(image.image.data()),
                                   image.image.size());
    const std::string_view png =
        image.bufferView >= 0 ? view_bytes(gltf.model, image.bufferView) : inlined;
    if (!png.starts_with(kBegin) || png.size() < kBegin.size() + 8) return {};
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(png[at + i]);
        return value;
    };
    return ImageSize{word(kBegin.size()), word(kBegin.size() + 4)};
}

/// The same charts in another size are other charts: UVs would lead to foreign texels.
void require_size(const GltfFile& gltf, std::uint32_t atlas, const fs::path& file,
                  const Lightmap& lightmap) {
    const auto size = size_in_gltf(gltf, atlas);
    if (!size || (lightmap.width == size->width && lightmap.height == size->height)) return;
    fail(file, "has " + size_text(lightmap.width, lightmap.height) + " texels, the lightmap of " +
                   gltf.file.name + " " + size_text(size->width, size->height) +
                   ": it is another scene's, or solved otherwise");
}

std::string text_in(const ExrLightmap& exr, const std::string& name) {
    const auto found = exr.attributes.find(name);
    return found == exr.attributes.end() ? "" : found->second;
}

/// An atlas more. A file of another solve may have been left beside the first.
void add_lightmap(LitScene& lit, const fs::path& file) {
    ExrLightmap read = read_exr(file, lit.scene.bands);
    const auto quantity =
        text_in(read, "quantity") == "radiosity" ? Quantity::radiosity : Quantity::irradiance;
    const std::string settings = text_in(read, "settings");
    if (!lit.lightmaps.empty() && (settings != lit.settings || quantity != lit.quantity))
        fail(file, "is not of the solve that " + printable(lit.exr.filename().string()) + " is of");
    lit.settings = settings;
    lit.quantity = quantity;
    lit.lightmaps.push_back(std::move(read.lightmap));
}

/// None where an atlas is missing, or of another solve.
std::optional<Snapshot> read_snapshot(const LitScene& lit, std::uint64_t shots) try {
    Snapshot snapshot{shots, {}};
    for (std::uint32_t atlas = 0; atlas < lit.lightmaps.size(); ++atlas) {
        ExrLightmap read =
            read_exr(snapshot_file(atlas_file(lit.exr, atlas), shots), lit.scene.bands);
        if (read.lightmap.width != lit.lightmaps[atlas].width ||
            read.lightmap.height != lit.lightmaps[atlas].height ||
            text_in(read, "settings") != lit.settings)
            return {};
        snapshot.lightmaps.push_back(std::move(read.lightmap));
    }
    return snapshot;
} catch (const InputError&) {
    return {};
}

}  // namespace

LitScene read_lit_scene(const fs::path& gltf, const std::optional<fs::path>& exr) {
    LitScene lit;
    lit.scene = read_scene(gltf);
    require_uvs(gltf, lit.scene);
    lit.cameras = read_cameras(gltf);
    const InputFile file = read_input_file(gltf);
    const GltfFile loaded = load_gltf(file);
    const Json& json = loaded.json;
    lit.exr = exr ? *exr : exr_of(gltf, json);
    const std::size_t count = atlas_count_in(json, gltf);
    lit.atlas_of = atlases_of(lit.scene, json, count, gltf);
    const bool is_ours = json.contains(Json::json_pointer("/asset/extras/hemirad/atlases"));
    for (std::uint32_t atlas = 0; atlas < count; ++atlas) {
        const fs::path exr_of_atlas = atlas_file(lit.exr, atlas);
        add_lightmap(lit, exr_of_atlas);
        lit.scene.side_files.push_back(exr_of_atlas.string());
        if (is_ours) require_size(loaded, atlas, exr_of_atlas, lit.lightmaps.back());
    }
    return lit;
}

std::optional<std::uint64_t> shots_in_name(const fs::path& exr, const fs::path& file) {
    const std::string prefix = exr.stem().string() + "-", stem = file.stem().string();
    if (file.extension() != exr.extension() || !stem.starts_with(prefix)) return {};
    const char *first = stem.data() + prefix.size(), *last = stem.data() + stem.size();
    std::uint64_t shots = 0;
    const auto [rest, fault] = std::from_chars(first, last, shots);
    if (fault != std::errc() || rest != last) return {};
    return shots;
}

std::set<std::uint64_t> shots_kept(const fs::path& exr) {
    std::set<std::uint64_t> found;
    const fs::path folder = exr.has_parent_path() ? exr.parent_path() : ".";
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (const auto shots = shots_in_name(exr, entry.path())) found.insert(*shots);
    return found;
}

fs::path snapshot_file(const fs::path& exr, std::uint64_t shots) {
    fs::path file = exr;
    file.replace_filename(exr.stem().string() + "-" + std::to_string(shots) +
                          exr.extension().string());
    return file;
}

std::vector<Snapshot> read_snapshots(const LitScene& scene) {
    std::vector<Snapshot> snapshots;
    for (const std::uint64_t shots : shots_kept(scene.exr))
        if (auto snapshot = read_snapshot(scene, shots)) snapshots.push_back(std::move(*snapshot));
    return snapshots;
}

}  // namespace hemirad
