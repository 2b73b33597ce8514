#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "errors.h"
#include "scene/read_scene.h"

namespace hemirad::test {

using Json = nlohmann::ordered_json;

/// A folder for one test's files, gone with the test.
class SceneFolder {
  public:
    SceneFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "hemirad-scene-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~SceneFolder() { std::filesystem::remove_all(path_); }
    SceneFolder(const SceneFolder&) = delete;
    SceneFolder& operator=(const SceneFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }
    Scene read(const std::string& name, std::string_view bytes) const {
        return read_scene(write(name, bytes));
    }
    Scene read(const Json& gltf) const { return read("room.gltf", gltf.dump()); }

    /// What the reader says of the file; empty if it takes it.
    std::string error_of(const std::string& name, std::string_view bytes) const {
        return error_of(write(name, bytes));
    }
    std::string error_of(const Json& gltf) const { return error_of("room.gltf", gltf.dump()); }
    std::string error_of(const std::filesystem::path& path) const {
        try {
            read_scene(path);
        } catch (const InputError& error) {
            return error.what();
        }
        return {};
    }

  private:
    std::filesystem::path path_;
};

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group =
                group << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            const bool padding = i + j > bytes.size();
            text += padding ? '=' : kDigits[group >> (18 - 6 * j) & 63];
        }
    }
    return text;
}

template <class Value>
std::string bytes_of(const std::vector<Value>& values) {
    std::string bytes(values.size() * sizeof(Value), '\0');
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

/// Adds a buffer, its bufferView and an accessor; returns the accessor's index.
template <class Value>
std::size_t add_accessor(Json& gltf, const std::vector<Value>& values, const std::string& type,
                         int component_type, std::size_t count) {
    const std::string bytes = bytes_of(values);
    gltf["buffers"].push_back({{"byteLength", bytes.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    gltf["bufferViews"].push_back(
        {{"buffer", gltf["buffers"].size() - 1}, {"byteLength", bytes.size()}});
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", component_type},
                                 {"count", count},
                                 {"type", type}});
    return gltf["accessors"].size() - 1;
}

inline std::size_t add_positions(Json& gltf, const std::vector<float>& values) {
    return add_accessor(gltf, values, "VEC3", 5126, values.size() / 3);
}

/// (0,0,0) (1,0,0) (0,1,0) in node "sheet", mesh "triangle", no indices, no material.
inline Json triangle_gltf() {
    Json gltf = {{"asset", {{"version", "2.0"}}}};
    add_positions(gltf, {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const Json primitive = {{"attributes", {{"POSITION", 0}}}};
    gltf["meshes"] =
        Json::array({{{"name", "triangle"}, {"primitives", Json::array({primitive})}}});
    gltf["nodes"] = Json::array({{{"name", "sheet"}, {"mesh", 0}}});
    return gltf;
}

/// The same with one material.
inline Json triangle_gltf(const Json& material) {
    Json gltf = triangle_gltf();
    gltf["materials"] = Json::array({material});
    gltf["meshes"][0]["primitives"][0]["material"] = 0;
    return gltf;
}

inline std::string little_endian(std::size_t value) {
    std::string bytes;
    for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(value >> shift & 255);
    return bytes;
}

/// Moves buffer 0 of the triangle into the binary chunk.
inline std::string glb(Json gltf) {
    const std::string binary = bytes_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
    gltf["buffers"][0].erase("uri");
    std::string json = gltf.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    return "glTF" + little_endian(2) + little_endian(28 + json.size() + binary.size()) +
           little_endian(json.size()) + "JSON" + json + little_endian(binary.size()) +
           std::string("BIN\0", 4) + binary;
}

}  // namespace hemirad::test
