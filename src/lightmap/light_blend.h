#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "lightmap/patch_lookup.h"
#include "scene/mesh.h"

namespace hemirad {

struct PatchWeight {
    std::uint32_t patch;
    double weight;
};

/// Light between patches where a grid of cells does not tell it: about walls, over which nothing
/// is blended, and where surfaces of one plane meet, over whose edges it goes on.
class LightBlend {
  public:
    enum class Across { all_materials, one_material };

    /// `hidden` patches lend their light to nobody. What is given must outlive this.
    LightBlend(const Mesh& mesh, const std::vector<bool>& hidden, Across across);

    /// Whether light about the place, as seen from the patch, is more than its surface's cells.
    bool is_needed(std::uint32_t patch, const glm::dvec2& place) const;

    /// What light at the place (s, t in metres, on the patch's surface or a little beyond) is made
    /// of: bilinear between the cells' centres, each the mean, by area, of its patches that the
    /// patch sees, and where it has no patches of what the plane's other surfaces have there.
    /// Weights are positive; never empty.
    void blend(std::uint32_t patch, const glm::dvec2& place, std::vector<PatchWeight>& made_of);

    /// Who has the place where it lies beyond the patch's surface: of the plane's other surfaces, a
    /// patch that nothing parts from this one; kNoPatch where there is none.
    std::uint32_t beyond(std::uint32_t patch, const glm::dvec2& place) const;

    /// Whether nothing stands on the surface on the straight way.
    bool is_open(std::uint32_t surface, const glm::dvec2& from, const glm::dvec2& to) const {
        return lookups_[surface].is_open(from, to);
    }

  private:
    /// A cell of a surface's grid, of a patch's own size.
    struct Node {
        std::int64_t column, row;
        double weight;
        bool beyond;  ///< may take what is missing from the next surface
    };

    void find_neighbours();
    void find_full_cells(std::uint32_t surface);
    bool may_meet(std::uint32_t a, std::uint32_t b) const;
    void blend_nodes(std::uint32_t patch, const glm::dvec2& place, double weight, bool beyond,
                     std::vector<PatchWeight>& made_of);
    void add_node(std::uint32_t patch, const Node& node, std::vector<PatchWeight>& made_of);
    void add_seen(std::uint32_t patch, double weight, std::vector<PatchWeight>& made_of);
    void add_beyond(std::uint32_t patch, const glm::dvec2& place, double weight,
                    std::vector<PatchWeight>& made_of);
    bool sees(std::uint32_t patch, std::uint32_t other) const;
    glm::dvec2 cell_size(std::uint32_t patch) const;
    std::uint32_t scale_of(std::uint32_t patch) const;

    const Mesh& mesh_;
    const std::vector<bool>& hidden_;
    Across across_;
    std::vector<PatchLookup> lookups_;                    ///< by surface
    std::vector<std::vector<std::uint32_t>> neighbours_;  ///< by surface
    std::vector<std::vector<bool>> full_cells_;           ///< of surfaces that have neighbours
    std::vector<std::uint32_t> candidates_;
};

}  // namespace hemirad
