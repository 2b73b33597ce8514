#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scene/polygon.h"

namespace hemirad::meshing {

/// Ear clipping (Meisters 1975) of a simple polygon, the first ear first; empty where it is not
/// simple after all. Adds to `looks` the boxes and corners that were looked at.
std::vector<std::array<Corner, 3>> clip_ears(const Polygon& polygon, double precision,
                                             std::size_t* looks = nullptr);

}  // namespace hemirad::meshing
