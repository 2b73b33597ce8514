#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace hemirad {

/// A diffuse material. Both spectra hold one value a band of the scene.
struct Material {
    std::string name;
    std::vector<double> reflectance;  ///< in [0, 1]
    std::vector<double> emission;     ///< radiance, W/(m^2 sr), >= 0
    bool double_sided = false;        ///< reflects and emits on both sides
};

/// An input polygon; counter-clockwise order is the front.
struct Face {
    std::vector<std::uint32_t> vertices;  ///< three or more indices into Scene::positions
    std::uint32_t material = 0;
    std::uint32_t object = 0;
    /// Of each corner, where the file says where it lies in a lightmap (glTF's TEXCOORD_1): V runs
    /// down from the top. Empty where it does not.
    std::vector<glm::dvec2> lightmap_uvs = {};
};

/// What a file says, in world space and metres, nothing repaired yet.
/// Readers promise: finite positions, indices in range, finite spectra within their limits.
struct Scene {
    std::string file;                ///< name without folder, for messages
    std::vector<std::string> bands;  ///< {"R", "G", "B"} unless the file names others
    std::vector<glm::dvec3> positions;
    std::vector<Face> faces;  ///< in file order
    std::vector<Material> materials;
    std::vector<std::string> objects;  ///< name of each `o`/`g`, glTF node or View3D surface
    std::vector<std::uint32_t> obstructions = {};  ///< objects that hide others, no more
    /// m; an axis of a position was rounded by this at most when it was written. 0: unknown, the
    /// file held world coordinates as floats.
    double quantum = 0;
    std::uint32_t lights_not_taken = 0;  ///< glTF's points, spots and suns, of KHR_lights_punctual
    std::vector<std::string> warnings;   ///< one line each, for people
    /// Paths of what belongs to the scene besides `file`: what it was read from, pictures it names.
    std::vector<std::string> side_files = {};
};

}  // namespace hemirad
