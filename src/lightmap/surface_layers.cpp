#include "lightmap/surface_layers.h"

#include "lightmap/find_hidden.h"
#include "lightmap/footprint.h"

namespace hemirad {
namespace {

using Components = std::vector<std::string>;

const Components kAxes{"X", "Y", "Z"};

Layer empty_layer(const Atlas& atlas, const char* meaning, Components components) {
    Layer layer{std::move(components), {}, meaning};
    layer.values.assign(layer.components.size(),
                        std::vector<float>(std::size_t{atlas.width} * atlas.height));
    return layer;
}

/// Writes value_of(patch, place on its surface) for each texel that shows something.
template <class ValueOf>
void write(const Footprints& footprints, const Atlas& atlas, const ValueOf& value_of,
           Layer& layer) {
    const auto& [left, top, width, height] = footprints.within;
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const Footprint& from = footprints.texels[std::size_t{y} * width + x];
            if (from.patch == kNoPatch) continue;
            const glm::dvec2 centre(left + x + 0.5, top + y + 0.5);
            const glm::dvec3 value =
                value_of(from.patch, footprints.maps[from.map].place_of(centre));
            const std::size_t texel = std::size_t{top + y} * atlas.width + left + x;
            for (std::size_t i = 0; i < layer.values.size(); ++i)
                layer.values[i][texel] = static_cast<float>(value[static_cast<int>(i)]);
        }
}

template <class ValueOf>
void write_all(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
               const ValueOf& value_of, Layer& layer) {
    for_each_footprints(mesh, layout, atlas, find_hidden(mesh), [&](const Footprints& footprints) {
        write(footprints, layout.atlases[atlas], value_of, layer);
    });
}

}  // namespace

Layer position_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas) {
    Layer layer =
        empty_layer(layout.atlases[atlas], "position of the texel's centre, world space, m", kAxes);
    layer.exact = true;
    write_all(
        mesh, layout, atlas,
        [&](std::uint32_t patch, const glm::dvec2& place) {
            const Surface& surface = mesh.surfaces[mesh.patches[patch].surface];
            return surface.origin + place.x * surface.u_axis + place.y * surface.v_axis;
        },
        layer);
    return layer;
}

Layer normal_layer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas) {
    Layer layer = empty_layer(layout.atlases[atlas], "unit normal, world space", kAxes);
    write_all(
        mesh, layout, atlas,
        [&](std::uint32_t patch, const glm::dvec2&) {
            return mesh.surfaces[mesh.patches[patch].surface].normal;
        },
        layer);
    return layer;
}

Layer shots_layer(const Mesh& mesh, const ChartLayout& layout,
                  const std::vector<std::uint32_t>& shots_of, std::uint32_t atlas) {
    Layer layer = empty_layer(layout.atlases[atlas], "shots that the texel's patch made", {"Y"});
    layer.exact = true;
    write_all(
        mesh, layout, atlas,
        [&](std::uint32_t patch, const glm::dvec2&) { return glm::dvec3(shots_of[patch]); }, layer);
    return layer;
}

}  // namespace hemirad
