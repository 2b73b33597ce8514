#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "lightmap/chart_layout.h"
#include "lightmap/pack_rectangles.h"
#include "lightmap/patch_lookup.h"
#include "scene/mesh.h"

namespace hemirad {

/// The place (s, t in metres) on a surface of a point in its atlas, in texels.
struct PlaceMap {
    glm::dvec2 origin{}, per_x{}, per_y{};

    glm::dvec2 place_of(const glm::dvec2& texel) const {
        return origin + texel.x * per_x + texel.y * per_y;
    }
};

inline constexpr std::uint32_t kNoTexel = 0xffffffffu;

/// What part of a texel surfaces fill, and whose light it shows: that of the patch at its centre,
/// or where there is none of the one that fills the most; of a hidden one only where there is no
/// other.
struct Footprint {
    double coverage = 0.0;
    float largest = 0.0f;
    std::uint32_t patch = kNoPatch;
    std::uint32_t map = 0;
    /// Which of Footprints::texels shows what it shows: itself, or what it has its patch from;
    /// kNoTexel where the patch is hidden and nothing else is near.
    std::uint32_t from = kNoTexel;
};

/// Of a part of an atlas, row by row.
struct Footprints {
    Rectangle within;
    std::vector<Footprint> texels;
    std::vector<PlaceMap> maps;

    Footprint& at(std::uint32_t x, std::uint32_t y) {
        return texels[std::size_t{y - within.y} * within.width + (x - within.x)];
    }
};

/// Of an atlas, part by part: all triangles that the scene's UVs put into it, then each chart with
/// its gutter. Texels of the gutter, and those that show hidden patches, show what the nearest
/// other shows: these wherever one is, those up to the padding away.
void for_each_footprints(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
                         const std::vector<bool>& hidden,
                         const std::function<void(const Footprints&)>& visit);

}  // namespace hemirad
