#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "scene/mesh.h"

namespace hemirad {

inline constexpr std::uint32_t kNoPatch = 0xffffffffu;

/// Finds a surface's patches by place, and what stands between two places. Patches are numbered as
/// in the mesh, places are (s, t) in metres.
class PatchLookup {
  public:
    PatchLookup(const Mesh& mesh, std::uint32_t surface);

    /// Those that lie in a cell of 2^scale cells a side of the grid, or cover it.
    void find_in(std::uint32_t scale, std::int64_t column, std::int64_t row,
                 std::vector<std::uint32_t>& found) const;

    /// One that holds the place, kNoPatch where none does.
    std::uint32_t at(const glm::dvec2& place) const;

    const glm::dvec2& centroid(std::uint32_t patch) const;

    /// No wall stands on the straight way.
    bool is_open(const glm::dvec2& from, const glm::dvec2& to) const;

    /// Whether a wall runs through the cells about the place that a value there depends on.
    bool has_wall_near(std::uint32_t scale, const glm::dvec2& place) const;

  private:
    using Entry = std::pair<std::uint32_t, std::uint32_t>;  ///< cell or block of cells, what is in

    /// Blocks of the largest scale's cells.
    struct Range {
        std::int64_t low_column, high_column, low_row, high_row;
    };

    void add_wall(std::uint32_t wall);
    Range blocks_about(const glm::dvec2& from, const glm::dvec2& to, double slack) const;
    bool holds(std::uint32_t patch, const glm::dvec2& place) const;
    glm::dvec2 place_of(const glm::dvec3& point) const;

    const Mesh& mesh_;
    const Surface& surface_;
    std::uint32_t largest_scale_ = 0;
    std::uint32_t block_columns_ = 1, block_rows_ = 1;
    glm::dvec2 block_size_{1.0};
    std::vector<glm::dvec2> centroids_;
    std::vector<Entry> patches_in_cells_, walls_in_blocks_;  ///< sorted
};

}  // namespace hemirad
