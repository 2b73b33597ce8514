#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "scene/mesh.h"
#include "scene/surface_point.h"

namespace hemirad {

/// The point of a patch nearest to a place on its surface (s, t in metres), but not so near to the
/// patch's outline that one could not tell on which side of what stands there it is: a hundredth of
/// a texel inside; a quarter where the place lies outside, so that it stands for what of the texel
/// the patch fills.
SurfacePoint point_on_patch(const Mesh& mesh, std::uint32_t patch, const glm::dvec2& place,
                            double texel);

}  // namespace hemirad
