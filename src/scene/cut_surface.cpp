#include "scene/cut_surface.h"

#include <numeric>
#include <span>
#include <utility>

#include "scene/cut_cells.h"
#include "scene/merge_pieces.h"
#include "scene/polygon.h"

namespace hemirad::meshing {
namespace {

using Cell = std::span<const CellPiece>;

using Corners = std::array<std::uint32_t, 4>;

Corners corners_of(const Polygon& polygon) {
    return {polygon[0].vertex, polygon[1].vertex, polygon[2].vertex, polygon.back().vertex};
}

Corners turned_over(const Corners& corners) {
    const auto [a, b, c, d] = corners;
    return d == c ? Corners{a, c, b, b} : Corners{a, d, c, b};
}

std::vector<MergedPiece> unmerged(Cell cell, double precision) {
    std::vector<MergedPiece> pieces;
    for (std::uint32_t p = 0; p < cell.size(); ++p)
        pieces.push_back({without_straight_corners(cell[p].polygon, precision), {p}});
    return pieces;
}

// Shares a piece's area out to the elements that its merged polygon was cut into. Shares add up to
// the whole piece, also where straight corners that were left out had moved the outline a little.
void share_out(const CellPiece& piece, std::span<const CellPiece> elements,
               std::uint32_t first_patch, std::vector<Fragment>& fragments) {
    std::vector<double> shares{1.0};
    if (elements.size() > 1) {
        shares.clear();
        for (const CellPiece& element : elements)
            shares.push_back(common_area(piece.polygon, element.polygon));
    }
    const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
    if (total <= 0) return;
    const double whole = area(piece.polygon);
    for (std::uint32_t i = 0; i < elements.size(); ++i)
        if (shares[i] > 0)
            fragments.push_back({piece.face, first_patch + i, whole * shares[i] / total});
}

class SurfaceCutter {
  public:
    SurfaceCutter(Grids grids, const Precision& precision, VertexWelder& vertices)
        : grid_(std::move(grids.patches)),
          precision_(precision),
          vertices_(vertices),
          cut_{std::move(grids.elements), {}, {}, {}} {}

    void cut(const FlatFaces& faces, const Group& group, Merging merging) {
        const auto pieces = cut_into_cells(faces, group, grid_, precision_, vertices_);
        for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
            while (end < pieces.size() && pieces[end].cell == pieces[begin].cell) ++end;
            const Cell cell(&pieces[begin], end - begin);
            const auto polygons = merging == Merging::none ? unmerged(cell, precision_.plane)
                                                           : merge_pieces(cell, precision_.plane);
            for (const MergedPiece& merged : polygons)
                if (merged.polygon.size() > 2) add(merged, cell);
        }
    }

    CutSurface take() { return std::move(cut_); }

  private:
    void add(const MergedPiece& merged, Cell cell) {
        const auto first_patch = static_cast<std::uint32_t>(cut_.patches.size());
        std::vector<CellPiece> elements;
        for (const Polygon& shooter : cut_into_quads(merged.polygon, precision_.plane))
            for (CellPiece& element : add_shooter({cell.front().cell, 0, shooter}))
                elements.push_back(std::move(element));
        if (elements.empty()) return;
        for (const std::uint32_t piece : merged.pieces)
            share_out(cell[piece], elements, first_patch, cut_.fragments);
    }

    std::vector<CellPiece> add_shooter(const CellPiece& shooter) {
        auto elements = elements_of(shooter);
        if (elements.empty()) return {};
        cut_.shooters.push_back({corners_of(shooter.polygon), 0,
                                 static_cast<std::uint32_t>(cut_.patches.size()),
                                 static_cast<std::uint32_t>(elements.size())});
        for (const CellPiece& element : elements) {
            cut_.patches.push_back({corners_of(element.polygon), 0});
            cut_.surface.cell_of_patch.push_back(element.cell);
        }
        return elements;
    }

    std::vector<CellPiece> elements_of(const CellPiece& shooter) {
        const Surface& fine = cut_.surface;
        if (fine.columns == grid_.columns && fine.rows == grid_.rows) return {shooter};
        std::vector<CellPiece> elements;
        for (const CellPiece& piece :
             cut_into_cells(shooter.polygon, shooter.face, fine, precision_, vertices_))
            for (Polygon& quad : cut_into_quads(
                     without_straight_corners(piece.polygon, precision_.plane), precision_.plane))
                elements.push_back({piece.cell, piece.face, std::move(quad)});
        return elements;
    }

    Surface grid_;
    Precision precision_;
    VertexWelder& vertices_;
    CutSurface cut_;
};

}  // namespace

CutSurface cut_surface(const FlatFaces& faces, const Group& group, Grids grids, Merging merging,
                       const Precision& precision, VertexWelder& vertices) {
    SurfaceCutter cutter(std::move(grids), precision, vertices);
    cutter.cut(faces, group, merging);
    return cutter.take();
}

CutSurface turn_over(CutSurface cut) {
    Surface& surface = cut.surface;
    surface.is_back = true;
    surface.origin += surface.columns * surface.cell_size.x * surface.u_axis;
    surface.u_axis = -surface.u_axis;
    surface.normal = -surface.normal;
    for (std::uint32_t& cell : surface.cell_of_patch) {
        const std::uint32_t column = cell % surface.columns;
        cell += surface.columns - 1 - 2 * column;
    }
    for (Patch& patch : cut.patches) patch.corners = turned_over(patch.corners);
    for (Shooter& shooter : cut.shooters) shooter.corners = turned_over(shooter.corners);
    cut.fragments.clear();
    return cut;
}

void append(CutSurface cut, Mesh& mesh) {
    if (cut.patches.empty()) return;
    cut.surface.first_patch = static_cast<std::uint32_t>(mesh.patches.size());
    cut.surface.patch_count = static_cast<std::uint32_t>(cut.patches.size());
    const auto index = static_cast<std::uint32_t>(mesh.surfaces.size());
    for (const Patch& patch : cut.patches) mesh.patches.push_back({patch.corners, index});
    for (const auto& [corners, surface, first_patch, patch_count] : cut.shooters)
        mesh.shooters.push_back(
            {corners, index, cut.surface.first_patch + first_patch, patch_count});
    for (const auto& [face, patch, area] : cut.fragments)
        mesh.fragments.push_back({face, cut.surface.first_patch + patch, area});
    mesh.surfaces.push_back(std::move(cut.surface));
}

}  // namespace hemirad::meshing
