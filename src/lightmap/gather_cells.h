#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lightmap/footprint.h"
#include "lightmap/light_blend.h"
#include "lightmap/lightmap.h"
#include "scene/mesh.h"
#include "scene/surface_point.h"

namespace hemirad {

/// What interpolated light may be off by, [band], W/m^2: `error` of the light about it, or of
/// `least` where there is less.
struct GatherTolerance {
    double error = 0;
    std::vector<double> least;
};

/// The texels of a chart, or of an atlas of authored charts, while light is gathered at some of
/// them: at the corners of cells of 16 x 16 texels, which are split in four where the light in the
/// middle of them and of their sides is not what their corners tell, where what is known of it from
/// the patches differs between, and where they are not of one side of one surface. In others light
/// is bilinear.
class GatherCells {
  public:
    /// What is given must outlive this. `guide`: the atlas as interpolated from the patches.
    GatherCells(const Mesh& mesh, const LightBlend& blend, const Lightmap& guide,
                const GatherTolerance& tolerance, Footprints footprints);

    /// The points whose light has to be known next; none when all is done.
    std::vector<SurfacePoint> wanted();

    /// Of the points that wanted() gave, [band][first + point]. Whether there may be more to want.
    bool take(const std::vector<std::vector<double>>& irradiance, std::size_t first);

    /// Gutters and what is under blocks show the nearest others; where the plane goes on beyond the
    /// chart, its gutter has gathered its own. Into the atlas, whose [band][texel]s have as many
    /// bands as the guide.
    void write(std::vector<std::vector<float>>& irradiance,
               std::vector<std::uint32_t>& patch_of_texel) const;

    std::size_t shown_count() const { return shown_count_; }
    std::size_t gathered_count() const { return gathered_count_; }
    std::size_t interpolated_count() const { return interpolated_count_; }

  private:
    /// Corners included.
    struct Cell {
        std::uint32_t left, top, right, bottom;

        bool is_whole() const { return right - left <= 1 && bottom - top <= 1; }
        std::uint32_t middle_column() const { return (left + right) / 2; }
        std::uint32_t middle_row() const { return (top + bottom) / 2; }
    };
    enum class State : std::uint8_t { nothing, wanted, gathered, interpolated };

    std::uint32_t at(std::uint32_t x, std::uint32_t y) const {
        return y * footprints_.within.width + x;
    }
    std::uint32_t in_atlas(std::uint32_t texel) const;
    bool is_shown(std::uint32_t texel) const { return footprints_.texels[texel].from == texel; }
    glm::dvec2 place_of(std::uint32_t texel, std::uint32_t map) const;
    glm::dvec2 place_of(std::uint32_t texel) const;
    double texel_length(std::uint32_t map) const;
    SurfacePoint point_of(std::uint32_t texel) const;

    void lay_cells();
    void want(std::uint32_t texel);
    void want_nodes(const Cell& cell);
    void want_gutter();
    void split(const Cell& cell);
    void settle(const Cell& cell);
    template <class Visit>
    bool all_of(const Cell& cell, const Visit& visit) const;
    bool has_light(const Cell& cell) const;
    bool is_uniform(const Cell& cell) const;
    bool is_open(const Cell& cell) const;
    bool is_flat(const Cell& cell) const;
    bool is_flat(const Cell& cell, std::size_t band) const;
    void interpolate(const Cell& cell);

    const Mesh& mesh_;
    const LightBlend& blend_;
    const Lightmap& guide_;
    const GatherTolerance& tolerance_;
    Footprints footprints_;
    std::vector<State> states_;
    std::vector<std::vector<float>> values_;  ///< [band][texel]
    std::vector<std::uint32_t> beyond_;       ///< [texel] of the gutter, whose patch it gathers at
    std::vector<Cell> cells_;
    std::vector<std::uint32_t> wanted_;
    std::size_t shown_count_ = 0, gathered_count_ = 0, interpolated_count_ = 0;
};

}  // namespace hemirad
