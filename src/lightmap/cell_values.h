#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

/// A value for every cell of a surface's grid, from its patches' of one side. On each scale, of
/// cells of 2^scale cells of the grid a side, a cell has the mean of the patches in it, by area;
/// where a patch covers more, what the next larger scale's cells give at its centre. So values vary
/// over a large patch as they would over a coarse grid.
class CellValues {
  public:
    /// Areas, in any unit, and values of the surface's patches; of those that are on `side`.
    CellValues(const Surface& surface, std::span<const double> areas,
               std::span<const double> values, std::uint32_t side = 0);

    /// Bilinear between the centres of the grid's cells, at a position in cells; constant beyond
    /// the outermost ones. Cells without a value are left out; where all four about the position
    /// are, that of `fallback`.
    double at(const glm::dvec2& position, std::uint32_t fallback) const;

    /// On the surface's `scale`, in cells of that; NaN where there is none, as outside the grid.
    double at_scale(std::uint32_t scale, std::int64_t column, std::int64_t row) const;

  private:
    struct Grid {
        std::uint32_t columns, rows;
        std::vector<double> values;  ///< NaN: none
        std::vector<bool> covered;   ///< by a patch of this scale or larger

        double interpolate(const glm::dvec2& position) const;
    };

    void refine(std::uint32_t scale);

    std::vector<Grid> grids_;  ///< by scale
};

/// Of each side of the surface.
std::vector<CellValues> cell_values_by_side(const Surface& surface, std::span<const double> areas,
                                            std::span<const double> values);

}  // namespace hemirad
