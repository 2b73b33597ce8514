#include "scene/read_scene.h"

#include <algorithm>
#include <string>

#include "errors.h"
#include "scene/input_file.h"

namespace hemirad {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension;
}

Scene read_format(const std::string& extension, const InputFile& file) {
    if (is_gltf(file.path)) return read_gltf(file);
    if (extension == ".obj") return read_obj(file);
    if (extension == ".vs3") return read_vs3(file);
    throw InputError(file.name + ": is neither .gltf, .glb, .obj nor .vs3");
}

}  // namespace

bool is_gltf(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    return extension == ".gltf" || extension == ".glb";
}

Scene read_scene(const std::filesystem::path& path) {
    const InputFile file = read_input_file(path);
    if (file.bytes.empty()) throw InputError(file.name + ": is empty");

    Scene scene = read_format(lower_extension(path), file);
    check_scene(file, scene);
    return scene;
}

}  // namespace hemirad
