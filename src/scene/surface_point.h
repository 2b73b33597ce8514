#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace hemirad {

/// Where light is asked for.
struct SurfacePoint {
    glm::dvec3 position{};    ///< world space, m, on the patch
    std::uint32_t patch = 0;  ///< whose front it lies on
    std::uint32_t turn = 0;   ///< of the hemisphere's disk, in 2^-32 of its range
};

}  // namespace hemirad
