#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace hemirad {

/// A perspective camera; the directions are of unit length, `up` across `forward`.
struct Camera {
    std::string name;
    glm::dvec3 eye{}, forward{0, 0, -1}, up{0, 1, 0};
    double yfov = 0.8;  ///< radians, from top to bottom
    double aspect = 0;  ///< width / height; 0: the picture's
};

/// Those of perspective in a glTF, by the names of their nodes, in world space; none in scenes of
/// other formats. Throws InputError.
std::vector<Camera> read_cameras(const std::filesystem::path& scene);

}  // namespace hemirad
