#pragma once

#include <filesystem>
#include <string>

#include "lightmap/lightmap.h"
#include "lightmap/lightmap_uvs.h"
#include "scene/camera.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// The scene as glTF 2.0, binary where the path ends in .glb, else one JSON file with all in it.
/// A node an object, in world coordinates, then the cameras. TEXCOORD_1 leads into the lightmap,
/// and so does TEXCOORD_0, without which glTF allows none. A material names the lightmap in its
/// extension MOZ_lightmap: an 8-bit PNG, linear, which times the extension's intensity is
/// irradiance, W/m^2; of bands that are not three those that shown_bands() names. `exr` is where
/// the exact values are, as seen from the glTF's folder: asset.extras.hemirad.exr.
/// The lightmap must hold irradiance. Throws OutputError.
void write_gltf(const std::filesystem::path& path, const Scene& scene, const Mesh& mesh,
                const std::vector<Camera>& cameras, const std::vector<UvTriangle>& triangles,
                const Lightmap& lightmap, const std::filesystem::path& exr);

}  // namespace hemirad
