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
    /// Areas, in any unit, and values of the surface's patches; `patches`, by their number in it,
    /// are those on the side.
    CellValues(const Surface& surface, std::span<const double> areas,
               std::span<const double> values, std::span<const std::uint32_t> patches);

    /// Bilinear between the centres of the grid's cells, at a position in cells; constant beyond
    /// the outermost ones. Cells without a value are left out; where all four about the position
    /// are, that of `fallback`.
    double at(const glm::dvec2& position, std::uint32_t fallback) const;

    /// On the surface's `scale`, in cells of that; NaN where there is none, as outside the grid.
    double at_scale(std::uint32_t scale, std::int64_t column, std::int64_t row) const;

  private:
    /// Holds blocks of cells in which there are patches of the side: of 255 sides most have few.
    class Grid {
      public:
        Grid(std::uint32_t columns, std::uint32_t rows);

        void hold(std::uint32_t column, std::uint32_t row);
        std::size_t held_count() const;
        /// Below held_count(), of a cell that is held.
        std::size_t index_of(std::uint32_t column, std::uint32_t row) const;

        double value(std::uint32_t column, std::uint32_t row) const;
        double interpolate(const glm::dvec2& position) const;

        std::uint32_t columns, rows;
        std::vector<double> values;  ///< of cells that are held; NaN: none

      private:
        std::size_t block_of(std::uint32_t column, std::uint32_t row) const;

        std::uint32_t column_bits_, row_bits_;  ///< of a place in a block
        std::uint32_t held_blocks_ = 0;
        std::vector<std::uint32_t> blocks_;  ///< by place; their numbers from 1, 0: not held
    };

    void refine(const Surface& surface, std::span<const std::uint32_t> patches,
                std::uint32_t scale);

    std::vector<Grid> grids_;  ///< by scale
};

/// Of each side of the surface.
std::vector<CellValues> cell_values_by_side(const Surface& surface, std::span<const double> areas,
                                            std::span<const double> values);

}  // namespace hemirad
