#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace hemirad {

/// Reads a .gltf, .glb, .obj or .vs3 file. Throws InputError, `FILE: ELEMENT: REASON`, for everything
/// that Scene does not allow.
Scene read_scene(const std::filesystem::path& path);

}  // namespace hemirad
