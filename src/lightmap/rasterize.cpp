#include "lightmap/rasterize.h"

#include <map>
#include <span>

#include "lightmap/cell_values.h"
#include "lightmap/find_hidden.h"
#include "lightmap/footprint.h"
#include "lightmap/light_blend.h"

namespace hemirad {
namespace {

/// A weighted mean that is exact where all values are equal.
double mean_of(std::span<const PatchWeight> made_of, const std::vector<double>& values) {
    const double pivot = values[made_of.front().patch];
    double weight = 0, moment = 0;
    for (const PatchWeight& part : made_of) {
        weight += part.weight;
        moment += part.weight * (values[part.patch] - pivot);
    }
    return pivot + moment / weight;
}

class Rasterizer {
  public:
    Rasterizer(const Mesh& mesh, const std::vector<std::vector<double>>& patch_values,
               LightBlend::Across across, Lightmap& lightmap)
        : mesh_(mesh),
          patch_values_(patch_values),
          hidden_(find_hidden(mesh)),
          blend_(mesh, hidden_, across),
          lightmap_(lightmap) {}

    const std::vector<bool>& hidden() const { return hidden_; }

    void write(const Footprints& footprints) {
        const auto& [left, top, width, height] = footprints.within;
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const Footprint& from = footprints.texels[std::size_t{y} * width + x];
                if (from.patch == kNoPatch) continue;
                const std::size_t texel = std::size_t{top + y} * lightmap_.width + left + x;
                const glm::dvec2 centre(left + x + 0.5, top + y + 0.5);
                lightmap_.coverage[texel] = static_cast<float>(from.coverage);
                write_texel(texel, from.patch, footprints.maps[from.map].place_of(centre));
            }
        cells_.clear();
    }

  private:
    void write_texel(std::size_t texel, std::uint32_t patch, const glm::dvec2& place) {
        if (blend_.is_needed(patch, place)) {
            blend_.blend(patch, place, made_of_);
            for (std::size_t band = 0; band < patch_values_.size(); ++band)
                lightmap_.values[band][texel] =
                    static_cast<float>(mean_of(made_of_, patch_values_[band]));
            return;
        }
        const Surface& surface = mesh_.surfaces[mesh_.patches[patch].surface];
        const std::uint32_t i = patch - surface.first_patch;
        const auto& cells = cells_of(mesh_.patches[patch].surface);
        for (std::size_t band = 0; band < patch_values_.size(); ++band)
            lightmap_.values[band][texel] = static_cast<float>(cells[band][surface.side(i)].at(
                place / surface.cell_size, surface.cell_of_patch[i]));
    }

    /// [band][side]
    using BandCells = std::vector<std::vector<CellValues>>;

    const BandCells& cells_of(std::uint32_t index) {
        const auto [entry, is_new] = cells_.try_emplace(index);
        if (!is_new) return entry->second;
        const Surface& surface = mesh_.surfaces[index];
        std::vector<double> areas;
        for (std::uint32_t i = 0; i < surface.patch_count; ++i)
            areas.push_back(mesh_.area(mesh_.patches[surface.first_patch + i]));
        for (const auto& values : patch_values_)
            entry->second.push_back(cell_values_by_side(
                surface, areas,
                std::span(values).subspan(surface.first_patch, surface.patch_count)));
        return entry->second;
    }

    const Mesh& mesh_;
    const std::vector<std::vector<double>>& patch_values_;
    std::vector<bool> hidden_;
    LightBlend blend_;
    Lightmap& lightmap_;
    std::map<std::uint32_t, BandCells> cells_;
    std::vector<PatchWeight> made_of_;
};

Lightmap empty_lightmap(const Atlas& atlas, const std::vector<std::string>& bands) {
    Lightmap lightmap{atlas.width, atlas.height, bands, {}, {}};
    lightmap.values.assign(bands.size(), std::vector<float>(lightmap.texel_count()));
    lightmap.coverage.resize(lightmap.texel_count());
    return lightmap;
}

}  // namespace

Lightmap rasterize(const Mesh& mesh, const Solution& solution, const ChartLayout& layout,
                   Quantity quantity, std::uint32_t atlas) {
    const bool irradiance = quantity == Quantity::irradiance;
    Lightmap lightmap = empty_lightmap(layout.atlases[atlas], solution.bands);
    Rasterizer rasterizer(
        mesh, irradiance ? solution.irradiance : solution.radiosity,
        irradiance ? LightBlend::Across::all_materials : LightBlend::Across::one_material,
        lightmap);
    for_each_footprints(mesh, layout, atlas, rasterizer.hidden(),
                        [&](const Footprints& footprints) { rasterizer.write(footprints); });
    return lightmap;
}

}  // namespace hemirad
