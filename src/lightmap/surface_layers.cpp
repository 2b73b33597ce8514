#include "lightmap/surface_layers.h"

#include <algorithm>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

namespace hemirad {
namespace {

/// The inverse of atlas_from_world() on the surface's plane, which is affine.
struct WorldFromAtlas {
    const Surface& surface;
    glm::dvec2 origin;            ///< the surface's, in texels
    glm::dmat2 plane_from_atlas;  ///< texels to m along the surface's axes

    WorldFromAtlas(const Chart& chart, const Surface& of)
        : surface(of), origin(atlas_from_world(chart, of, of.origin)) {
        const auto step = [&](const glm::dvec3& axis) {
            return atlas_from_world(chart, surface, surface.origin + axis) - origin;
        };
        plane_from_atlas = glm::inverse(glm::dmat2(step(surface.u_axis), step(surface.v_axis)));
    }

    glm::dvec3 operator()(const glm::dvec2& texel) const {
        const glm::dvec2 at = plane_from_atlas * (texel - origin);
        return surface.origin + at.x * surface.u_axis + at.y * surface.v_axis;
    }
};

/// Calls visit(texel, x, y) for a chart's texels and those of its gutter.
template <class Visit>
void for_texels(const ChartLayout& layout, const Chart& chart, const Visit& visit) {
    const auto first = [&](std::uint32_t start) { return start - std::min(start, layout.padding); };
    for (auto y = first(chart.y);
         y < std::min(chart.y + chart.height + layout.padding, layout.height); ++y)
        for (auto x = first(chart.x);
             x < std::min(chart.x + chart.width + layout.padding, layout.width); ++x)
            visit(std::size_t{y} * layout.width + x, x, y);
}

Layer empty_layer(const ChartLayout& layout, const char* meaning) {
    Layer layer{{"X", "Y", "Z"}, {}, meaning};
    layer.values.assign(3, std::vector<float>(std::size_t{layout.width} * layout.height));
    return layer;
}

void set(Layer& layer, std::size_t texel, const glm::dvec3& value) {
    for (int axis = 0; axis < 3; ++axis)
        layer.values[static_cast<std::size_t>(axis)][texel] = static_cast<float>(value[axis]);
}

}  // namespace

Layer position_layer(const Mesh& mesh, const ChartLayout& layout) {
    Layer layer = empty_layer(layout, "position of the texel's centre, world space, m");
    layer.exact = true;
    for (const Chart& chart : layout.charts) {
        const WorldFromAtlas world_from_atlas(chart, mesh.surfaces[chart.surface]);
        for_texels(layout, chart, [&](std::size_t texel, std::uint32_t x, std::uint32_t y) {
            set(layer, texel, world_from_atlas({x + 0.5, y + 0.5}));
        });
    }
    return layer;
}

Layer normal_layer(const Mesh& mesh, const ChartLayout& layout) {
    Layer layer = empty_layer(layout, "unit normal, world space");
    for (const Chart& chart : layout.charts)
        for_texels(layout, chart, [&](std::size_t texel, std::uint32_t, std::uint32_t) {
            set(layer, texel, mesh.surfaces[chart.surface].normal);
        });
    return layer;
}

}  // namespace hemirad
