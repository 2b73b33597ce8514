#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// Longest side of an atlas: what current GPUs take as a texture.
inline constexpr std::uint32_t kLargestAtlas = 16384;

struct ChartSettings {
    double texel_size = 0;      ///< m; 0: default_texel_size()
    std::uint32_t padding = 2;  ///< gutter around every chart, texels
};

/// A surface's place in the atlas, gutter not included. The chart shows the surface as seen from
/// its front: s to the right, t upwards, the top row being the largest t.
struct Chart {
    std::uint32_t surface = 0;
    std::uint32_t atlas = 0;
    std::uint32_t x = 0, y = 0;           ///< top left texel
    std::uint32_t width = 1, height = 1;  ///< texels
    glm::dvec2 texel_size{1.0};  ///< m; at most the layout's, so that whole texels fill the grid
};

struct ChartLayout {
    double texel_size = 0;  ///< m, as asked for
    std::uint32_t padding = 0;
    std::uint32_t width = 0, height = 0;  ///< of the atlas, texels
    std::vector<Chart> charts;            ///< in the order of their surfaces
};

/// Half the median over the charts of a grid's shorter cell edge, but not so small that the charts
/// alone would fill an atlas of 8192 x 8192.
double default_texel_size(const Mesh& mesh);

/// A chart for each surface that has one, packed into an atlas as square as possible.
/// The same mesh always gives the same layout. Throws InputError where the texel size is not
/// positive or the atlas would exceed kLargestAtlas.
ChartLayout lay_out_charts(const Mesh& mesh, const ChartSettings& settings = {});

/// Where a point of the surface lies in the atlas, in texels from its top left corner; the centre
/// of texel (x, y) is (x + 0.5, y + 0.5).
glm::dvec2 atlas_from_world(const Chart& chart, const Surface& surface, const glm::dvec3& point);

}  // namespace hemirad
