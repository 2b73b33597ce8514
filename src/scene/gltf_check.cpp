#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "scene/gltf_file.h"

namespace hemirad {
namespace {

struct Reference {
    std::string_view pattern, target;
};
constexpr auto kReferences = std::to_array<Reference>({
    {"scene", "scenes"},
    {"scenes/*/nodes/*", "nodes"},
    {"nodes/*/children/*", "nodes"},
    {"nodes/*/mesh", "meshes"},
    {"nodes/*/camera", "cameras"},
    {"meshes/*/primitives/*/indices", "accessors"},
    {"meshes/*/primitives/*/attributes/*", "accessors"},
    {"meshes/*/primitives/*/material", "materials"},
    {"accessors/*/bufferView", "bufferViews"},
    {"accessors/*/sparse/indices/bufferView", "bufferViews"},
    {"accessors/*/sparse/values/bufferView", "bufferViews"},
    {"bufferViews/*/buffer", "buffers"},
    {"images/*/bufferView", "bufferViews"},
    {"textures/*/source", "images"},
    {"materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures"},
    {"materials/*/emissiveTexture/index", "textures"},
});

struct Count {
    std::string_view pattern;
    std::int64_t least;
};
constexpr auto kCounts = std::to_array<Count>({
    {"buffers/*/byteLength", 1},
    {"bufferViews/*/byteOffset", 0},
    {"bufferViews/*/byteLength", 1},
    {"bufferViews/*/byteStride", 4},
    {"accessors/*/byteOffset", 0},
    {"accessors/*/componentType", 0},
    {"accessors/*/count", 1},
    {"accessors/*/sparse/count", 1},
    {"accessors/*/sparse/indices/byteOffset", 0},
    {"accessors/*/sparse/indices/componentType", 0},
    {"accessors/*/sparse/values/byteOffset", 0},
    {"meshes/*/primitives/*/mode", 0},
});

struct Numbers {
    std::string_view pattern;
    std::size_t size;
};
constexpr auto kNumbers = std::to_array<Numbers>({
    {"nodes/*/matrix", 16},
    {"nodes/*/translation", 3},
    {"nodes/*/rotation", 4},
    {"nodes/*/scale", 3},
    {"materials/*/pbrMetallicRoughness/baseColorFactor", 4},
    {"materials/*/emissiveFactor", 3},
});

// What may be required of a reader that takes diffuse colour and radiance from materials; of the
// others some change the geometry or where the bytes are.
constexpr auto kKnownExtensions = std::to_array<std::string_view>({
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
});

/// A material is held in three thousand bytes; the least that has a colour takes 64 in the file.
constexpr std::size_t kFewMaterials = 10'000, kBytesAMaterial = 64;

/// Bytes of an object's key in the path that messages show.
constexpr std::size_t kLongestKey = 100;

/// Calls visit(path, value) for every value that a pattern such as "nodes/*/mesh" reaches.
template <class Visit>
void for_each(const Json& value, std::string_view pattern, const std::string& path, Visit& visit) {
    if (pattern.empty()) return visit(path, value);
    const auto slash = pattern.find('/');
    const std::string_view key = pattern.substr(0, slash);
    const std::string_view rest =
        slash == std::string_view::npos ? std::string_view{} : pattern.substr(slash + 1);
    const std::string prefix = path.empty() ? "" : path + "/";
    if (key != "*") {
        const auto found = value.find(key);
        if (found != value.end()) for_each(*found, rest, prefix + std::string(key), visit);
        return;
    }
    if (!value.is_structured()) return;
    for (const auto& [name, child] : value.items()) {
        for_each(child, rest, prefix + printable(name.substr(0, kLongestKey)), visit);
    }
}

template <class Visit>
void for_each(const Json& json, std::string_view pattern, Visit visit) {
    for_each(json, pattern, std::string{}, visit);
}

std::int64_t checked_integer(const InputFile& file, const std::string& path, const Json& value) {
    constexpr double kLargest = std::numeric_limits<std::int32_t>::max();  // tinygltf's int
    if (!value.is_number_integer()) fail(file, path, "is not an integer");
    if (value.get<double>() < 0 || value.get<double>() > kLargest) {
        fail(file, path, value.dump() + " is out of range");
    }
    return value.get<std::int64_t>();
}

void check_references(const InputFile& file, const Json& json) {
    for (const auto& [pattern, target] : kReferences) {
        const std::string name(target);
        const auto found = json.find(name);
        const std::size_t size = found != json.end() && found->is_array() ? found->size() : 0;
        for_each(json, pattern, [&](const std::string& path, const Json& value) {
            const auto index = static_cast<std::size_t>(checked_integer(file, path, value));
            if (index < size) return;
            fail(file, path,
                 std::to_string(index) + " is out of range, the file holds " +
                     std::to_string(size) + " " + name);
        });
    }
}

void check_numbers(const InputFile& file, const Json& json) {
    for (const auto& [pattern, least] : kCounts) {
        for_each(json, pattern, [&, limit = least](const std::string& path, const Json& value) {
            if (checked_integer(file, path, value) >= limit) return;
            fail(file, path, value.dump() + " is below " + std::to_string(limit));
        });
    }
    for (const auto& [pattern, size] : kNumbers) {
        for_each(json, pattern, [&, expected = size](const std::string& path, const Json& value) {
            const bool numbers = std::all_of(value.begin(), value.end(),
                                             [](const Json& x) { return x.is_number(); });
            if (value.is_array() && value.size() == expected && numbers) return;
            fail(file, path, "must be " + std::to_string(expected) + " numbers");
        });
    }
}

void check_uris(const InputFile& file, const Json& json) {
    for (const std::string_view pattern : {"buffers/*/uri", "images/*/uri"}) {
        for_each(json, pattern, [&](const std::string& path, const Json& value) {
            if (!value.is_string()) fail(file, path, "is not a string");
            const auto& uri = value.get_ref<const std::string&>();
            if (uri.starts_with("data:")) return;
            if (!resolve_reference(file, uri)) {
                fail(file, path, in_quotes(uri) + " must be a file in the scene's folder");
            }
        });
    }
}

/// glTF 2.0, sec. 4.4.3.3: the first alone lies in a GLB's binary chunk. tinygltf would copy the
/// chunk for each that has no URI.
void check_binary_chunk(const InputFile& file, const Json& json) {
    for_each(json, "buffers/*", [&](const std::string& path, const Json& buffer) {
        if (path == "buffers/0" || !buffer.value("uri", "").empty()) return;
        fail(file, path, "has no uri, only the first buffer may lie in the binary chunk");
    });
}

/// tinygltf would quote the whole URI.
void check_data_uris(const InputFile& file, const Json& json) {
    constexpr std::string_view kMarker = ";base64,";
    for_each(json, "buffers/*", [&](const std::string& path, const Json& buffer) {
        const std::string uri = buffer.value("uri", "");
        const auto marker = uri.find(kMarker);
        if (!uri.starts_with("data:") || marker == std::string::npos) return;
        const auto digits = std::string_view(uri).substr(marker + kMarker.size());
        const auto count = std::min(digits.find('='), digits.size());
        const auto size = buffer.value("byteLength", std::size_t{0});
        if (count * 3 / 4 == size) return;
        fail(file, path, "its data URI does not hold " + std::to_string(size) + " bytes");
    });
}

void check_buffer_views(const InputFile& file, const Json& json) {
    for_each(json, "bufferViews/*", [&](const std::string& path, const Json& view) {
        if (!view.contains("buffer") || !view.contains("byteLength")) {
            fail(file, path, "needs a buffer and a byteLength");
        }
        const Json& buffer = json["buffers"][view["buffer"].get<std::size_t>()];
        const auto size = buffer.value("byteLength", std::int64_t{0});
        const auto end =
            view.value("byteOffset", std::int64_t{0}) + view["byteLength"].get<std::int64_t>();
        if (end <= size) return;
        fail(file, path,
             "ends at byte " + std::to_string(end) + " of a buffer of " + std::to_string(size));
    });
}

/// tinygltf drops a primitive without attributes, and the ones behind it would change their number.
void check_primitives(const InputFile& file, const Json& json) {
    for_each(json, "meshes/*", [&](const std::string& path, const Json& mesh) {
        const auto primitives = mesh.find("primitives");
        if (primitives != mesh.end() && primitives->is_array()) return;
        fail(file, path, "holds no array of primitives");
    });
    for_each(json, "meshes/*/primitives/*", [&](const std::string& path, const Json& primitive) {
        const auto attributes = primitive.find("attributes");
        if (attributes != primitive.end() && attributes->is_object()) return;
        fail(file, path, "holds no attributes");
    });
}

void check_materials(const InputFile& file, const Json& json) {
    const auto materials = json.find("materials");
    const std::size_t count = materials == json.end() ? 0 : materials->size();
    const std::size_t most = kFewMaterials + file.bytes.size() / kBytesAMaterial;
    if (count <= most) return;
    fail(file, "materials",
         "are " + std::to_string(count) + ", more than the " + std::to_string(most) +
             " that are read of " + std::to_string(file.bytes.size()) + " bytes");
}

void check_extensions(const InputFile& file, const Json& json) {
    for_each(json, "extensionsRequired/*", [&](const std::string& path, const Json& value) {
        if (!value.is_string()) fail(file, path, "is not a string");
        const auto& name = value.get_ref<const std::string&>();
        if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) !=
            kKnownExtensions.end()) {
            return;
        }
        fail(file, path, "the extension " + in_quotes(name) + " is not supported");
    });
}

void check_sections(const InputFile& file, const Json& json) {
    if (!json.is_object()) fail(file, "glTF", "is not a JSON object");
    for (const char* name : {"accessors", "buffers", "bufferViews", "cameras", "images",
                             "materials", "meshes", "nodes", "scenes", "textures"}) {
        const auto found = json.find(name);
        if (found == json.end()) continue;
        if (!found->is_array()) fail(file, name, "is not an array");
        for_each(*found, "*", [&](const std::string& index, const Json& value) {
            const std::string path = std::string(name) + "/" + index;
            if (!value.is_object()) fail(file, path, "is not an object");
        });
    }
}

/// glTF 2.0, 3.2: a client that knows 2.0 reads any 2.x that does not ask for more by `minVersion`.
void check_version(const InputFile& file, const Json& json) {
    const auto asset = json.find("asset");
    const bool has_version = asset != json.end() && asset->is_object() &&
                             asset->contains("version") && (*asset)["version"].is_string();
    if (!has_version) fail(file, "asset", "holds no version, this is not glTF 2.0");
    const auto& version = (*asset)["version"].get_ref<const std::string&>();
    if (!version.starts_with("2.")) fail(file, "asset", "glTF version " + in_quotes(version));
    const auto least = asset->find("minVersion");
    if (least == asset->end()) return;
    if (!least->is_string()) fail(file, "asset/minVersion", "is not a string");
    if (const auto& needed = least->get_ref<const std::string&>(); needed != "2.0")
        fail(file, "asset/minVersion", "needs glTF version " + in_quotes(needed));
}

}  // namespace

void check_gltf(const InputFile& file, const Json& json) {
    check_sections(file, json);
    check_version(file, json);
    check_extensions(file, json);
    check_materials(file, json);
    check_primitives(file, json);
    check_references(file, json);
    check_numbers(file, json);
    check_uris(file, json);
    check_binary_chunk(file, json);
    check_data_uris(file, json);
    check_buffer_views(file, json);
}

}  // namespace hemirad
