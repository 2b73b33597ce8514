#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// How light is told apart by where it comes from.
enum class Lights {
    together,     ///< not at all
    separate,     ///< by object or, where all emitters are of one, by material
    by_material,  ///< of one name
};

inline constexpr std::uint32_t kNoLight = 0xffffffffu;

/// Surfaces that emit, those of one name as one light.
struct LightGroups {
    std::vector<std::string> names;         ///< [light], in the order of their first surfaces
    std::vector<std::uint32_t> of_surface;  ///< [surface] light, or kNoLight where it emits nothing
};

/// No groups where lights are together.
LightGroups group_lights(const Mesh& mesh, Lights lights);

}  // namespace hemirad
