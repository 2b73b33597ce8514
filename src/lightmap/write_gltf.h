#pragma once

#include <filesystem>
#include <vector>

#include "lightmap/lightmap_image.h"
#include "lightmap/lightmap_uvs.h"
#include "scene/camera.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// The scene as glTF 2.0, binary where the path ends in .glb, else one JSON file with all in it.
/// A node an object, in world coordinates, then the cameras. TEXCOORD_1 leads into the lightmap,
/// and so does TEXCOORD_0, without which glTF allows none. A material names the lightmap in its
/// extension MOZ_lightmap; where its light lies in several atlases, of which each is a texture, it
/// is there once for each of these. `images` are those of the atlases, of irradiance. `exr` is
/// where the exact values are, as seen from the glTF's folder: asset.extras.hemirad.exr, those of
/// further atlases beside it, see atlas_file(); asset.extras.hemirad.atlases is their number.
/// Throws OutputError.
void write_gltf(const std::filesystem::path& path, const Scene& scene, const Mesh& mesh,
                const std::vector<Camera>& cameras, const std::vector<UvTriangle>& triangles,
                const std::vector<LightmapImage>& images, const std::filesystem::path& exr);

}  // namespace hemirad
