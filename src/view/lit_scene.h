#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lightmap/lightmap.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace hemirad {

/// What `hemirad solve --gltf` left: a scene of triangles with Face::lightmap_uvs, and its light.
struct LitScene {
    Scene scene;
    std::vector<Camera> cameras;
    std::vector<Lightmap> lightmaps;           ///< by atlas
    std::vector<std::uint32_t> atlas_of;       ///< by material: where the light of its faces is
    Quantity quantity = Quantity::irradiance;  ///< of the lightmaps
    std::filesystem::path exr;                 ///< where the first one lay, see atlas_file()
    std::string settings;                      ///< that they were solved with, as their headers say
};

/// `exr`: instead of the file that the glTF names, which lies in the glTF's folder or below.
/// Throws InputError, also where atlases were not solved with the same settings, or are not of the
/// size that the glTF's own picture of them has.
LitScene read_lit_scene(const std::filesystem::path& gltf,
                        const std::optional<std::filesystem::path>& exr);

/// An interim picture that was kept.
struct Snapshot {
    std::uint64_t shots = 0;
    std::vector<Lightmap> lightmaps;  ///< by atlas
};

/// The file in which the picture after so many shots is kept: NAME-SHOTS.exr beside NAME.exr.
std::filesystem::path snapshot_file(const std::filesystem::path& exr, std::uint64_t shots);

/// The other way round: nothing where a file's name is none of these.
std::optional<std::uint64_t> shots_in_name(const std::filesystem::path& exr,
                                           const std::filesystem::path& file);

/// After which shots there is such a file, whatever it holds.
std::set<std::uint64_t> shots_kept(const std::filesystem::path& exr);

/// Those that lie beside the scene's lightmaps and are of the same size, scene and settings, by
/// shots. Others are left out, and so is what cannot be read or lacks an atlas.
std::vector<Snapshot> read_snapshots(const LitScene& scene);

}  // namespace hemirad
