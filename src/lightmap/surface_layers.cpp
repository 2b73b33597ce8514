#include "lightmap/surface_layers.h"

#include "lightmap/find_hidden.h"
#include "lightmap/footprint.h"

namespace hemirad {
namespace {

Layer empty_layer(const Atlas& atlas, const char* meaning) {
    Layer layer{{"X", "Y", "Z"}, {}, meaning};
    layer.values.assign(3, std::vector<float>(std::size_t{atlas.width} * atlas.height));
    return layer;
}

/// Writes value_of(surface, place on it) for each texel that shows something.
template <class ValueOf>
void write(const Mesh& mesh, const Footprints& footprints, const Atlas& atlas,
           const ValueOf& value_of, Layer& layer) {
    const auto& [left, top, width, height] = footprints.within;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const Footprint& from = footprints.texels[std::size_t{y} * width + x];
            if (from.patch == kNoPatch) continue;
            const glm::dvec2 centre(left + x + 0.5, top + y + 0.5);
            const glm::dvec3 value = value_of(mesh.surfaces[mesh.patches[from.patch].surface],
                                              footprints.maps[from.map].place_of(centre));
            const std::size_t texel = std::size_t{top + y} * atlas.width + left + x;
            for (int axis = 0; axis < 3; ++axis)
                layer.values[static_cast<std::size_t>(axis)][texel] =
                    static_cast<float>(value[axis]);
        }
}

template <class ValueOf>
void write_all(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
               const ValueOf& value_of, Layer& layer) {
    for_each_footprints(mesh, layout, atlas, find_hidden(mesh), [&](const Footprints& footprints) {
        write(mesh, footprints, layout.atlases[atlas], value_of, layer);
    });
}

}  // namespace

Layer position_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas) {
    Layer layer =
        empty_layer(layout.atlases[atlas], "position of the texel's centre, world space, m");
    layer.exact = true;
    write_all(
        mesh, layout, atlas,
        [](const Surface& surface, const glm::dvec2& place) {
            return surface.origin + place.x * surface.u_axis + place.y * surface.v_axis;
        },
        layer);
    return layer;
}

Layer normal_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas) {
    Layer layer = empty_layer(layout.atlases[atlas], "unit normal, world space");
    write_all(
        mesh, layout, atlas,
        [](const Surface& surface, const glm::dvec2&) { return surface.normal; }, layer);
    return layer;
}

}  // namespace hemirad
