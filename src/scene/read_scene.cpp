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

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
    const InputFile file = read_input_file(path);
    if (file.bytes.empty()) throw InputError(file.name + ": is empty");

    const std::string extension = lower_extension(path);
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    if (!is_gltf && extension != ".obj") {
        throw InputError(file.name + ": is neither .gltf, .glb nor .obj");
    }
    Scene scene = is_gltf ? read_gltf(file) : read_obj(file);
    check_scene(file, scene);
    return scene;
}

}  // namespace hemirad
