#include "scene/cut_surface.h"

#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "scene/cut_cells.h"
#include "scene/cut_contacts.h"
#include "scene/find_sides.h"
#include "scene/merge_pieces.h"
#include "scene/polygon.h"
#include "scene/split_polygon.h"

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

// Past so many elements of one piece each counts as within it: to clip them all against it takes
// the square of its corners.
constexpr std::size_t kMostClipped = 64;

std::vector<double> shares_of(const CellPiece& piece, std::span<const Polygon> elements,
                              bool is_alone) {
    if (elements.size() == 1) return {1.0};
    std::vector<double> shares;
    for (const Polygon& element : elements)
        shares.push_back(is_alone && piece.polygon.size() > kMostClipped
                             ? area(element)
                             : common_area(piece.polygon, element));
    return shares;
}

// Shares a piece's area out to the elements that its merged polygon was cut into. Shares add up to
// the whole piece, also where straight corners that were left out had moved the outline a little.
void share_out(const CellPiece& piece, std::span<const Polygon> elements, bool is_alone,
               std::uint32_t first_patch, std::vector<Fragment>& fragments) {
    const auto shares = shares_of(piece, elements, is_alone);
    const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
    const double whole = area(piece.polygon);
    if (total <= 0 || whole <= 0) return;
    for (std::uint32_t i = 0; i < elements.size(); ++i)
        if (shares[i] > 0)
            fragments.push_back({piece.face, first_patch + i, whole * shares[i] / total});
}

class SurfaceCutter {
  public:
    SurfaceCutter(Grids grids, const Precision& precision, VertexWelder& vertices)
        : grids_(std::move(grids)),
          precision_(precision),
          vertices_(vertices),
          splitter_({grids_.patches.origin, grids_.patches.u_axis, grids_.patches.v_axis,
                     grids_.patches.normal},
                    vertices),
          slack_(contact_slack(grids_.patches, precision)),
          contacts_(std::move(grids_.contacts), grids_.patches, slack_),
          cut_{grids_.elements.back(), {}, {}, {}} {}

    void cut(const FlatFaces& faces, const Group& group, Merging merging) {
        const auto pieces = cut_into_cells(faces, group, grids_.patches, precision_, vertices_);
        for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
            while (end < pieces.size() && pieces[end].cell == pieces[begin].cell) ++end;
            const Cell cell(&pieces[begin], end - begin);
            contacts_here_ = contacts_.in(pieces[begin].cell);
            const auto polygons = merging == Merging::none ? unmerged(cell, precision_.plane)
                                                           : merge_pieces(cell, precision_.plane);
            for (const MergedPiece& merged : polygons)
                if (merged.polygon.size() > 2) add(merged, cell);
        }
    }

    CutSurface take() {
        if (!marks_.empty()) cut_.surface.side_of_patch = find_sides(pieces_, cut_.surface, marks_);
        return std::move(cut_);
    }

  private:
    void add(const MergedPiece& merged, Cell cell) {
        const auto first_patch = static_cast<std::uint32_t>(cut_.patches.size());
        elements_.clear();
        for (const Polygon& part :
             cut_along_contacts(merged.polygon, contacts_here_, slack_, precision_, splitter_))
            add_part({cell.front().cell, 0, part});
        if (elements_.empty() || !grids_.has_fragments) return;
        for (const std::uint32_t piece : merged.pieces)
            share_out(cell[piece], elements_, merged.pieces.size() == 1, first_patch,
                      cut_.fragments);
    }

    void add_part(const CellPiece& part) {
        const auto first_patch = static_cast<std::uint32_t>(cut_.patches.size());
        add_shooters(0, part);
        if (contacts_.empty()) return;
        SidePiece piece{
            {}, first_patch, static_cast<std::uint32_t>(cut_.patches.size()) - first_patch};
        for (const Corner& corner : part.polygon) piece.corners.push_back(corner.vertex);
        pieces_.push_back(std::move(piece));
        marks_.add(part.polygon, contacts_here_, slack_);
    }

    void add_shooters(std::uint32_t splits, const CellPiece& piece) {
        if (!splits_shooters(splits, piece.cell)) {
            for (const Polygon& quad : cut_into_quads(piece.polygon, precision_.plane))
                add_shooter(splits, {piece.cell, 0, quad});
            return;
        }
        for (CellPiece& part : cut_into_cells(
                 piece.polygon, piece.face, grids_.split_shooters[splits], precision_, vertices_)) {
            part.polygon = without_straight_corners(part.polygon, precision_.plane);
            if (part.polygon.size() > 2) add_shooters(splits + 1, part);
        }
    }

    const Surface& shooter_grid(std::uint32_t splits) const {
        return splits == 0 ? grids_.patches : grids_.split_shooters[splits - 1];
    }

    // The elements that fill the cells of a shooters' grid; none where it is coarser than all.
    std::optional<std::size_t> elements_like(const Surface& grid) const {
        for (std::size_t level = 0; level < grids_.elements.size(); ++level)
            if (grids_.elements[level].columns == grid.columns &&
                grids_.elements[level].rows == grid.rows)
                return level;
        return {};
    }

    bool splits_shooters(std::uint32_t splits, std::uint32_t cell) const {
        if (splits == grids_.split_shooters.size()) return false;
        const Surface& grid = shooter_grid(splits);
        const auto level = elements_like(grid);
        return is_deeper(grids_.shooter_depths, splits, block(grid, cell)) &&
               (!level || is_split(*level, cell));
    }

    void add_shooter(std::uint32_t splits, const CellPiece& shooter) {
        const auto first_patch = static_cast<std::uint32_t>(cut_.patches.size());
        const auto level = elements_like(shooter_grid(splits));
        if (!level)
            cut_along(0, shooter);
        else if (grids_.elements.size() > 1)
            add_piece(*level, shooter);
        else
            add_element(0, shooter.cell, shooter.polygon);
        const auto count = static_cast<std::uint32_t>(cut_.patches.size()) - first_patch;
        if (count > 0)
            cut_.shooters.push_back({corners_of(shooter.polygon), 0, first_patch, count, splits});
    }

    void cut_along(std::size_t level, const CellPiece& piece) {
        const Surface& grid = grids_.elements[level];
        for (const CellPiece& part :
             cut_into_cells(piece.polygon, piece.face, grid, precision_, vertices_))
            add_piece(level, part);
    }

    void add_piece(std::size_t level, const CellPiece& piece) {
        if (is_split(level, piece.cell)) {
            cut_along(level + 1, piece);
            return;
        }
        const auto polygon = without_straight_corners(piece.polygon, precision_.plane);
        for (const Polygon& quad : cut_into_quads(polygon, precision_.plane))
            add_element(level, piece.cell, quad);
    }

    bool is_split(std::size_t level, std::uint32_t cell) const {
        return is_deeper(grids_.depths, level, block(grids_.elements[level], cell));
    }

    void add_element(std::size_t level, std::uint32_t cell, const Polygon& polygon) {
        const auto [column, row, width, height] = block(grids_.elements[level], cell);
        cut_.patches.push_back({corners_of(polygon), 0});
        cut_.surface.cell_of_patch.push_back(row * cut_.surface.columns + column);
        if (grids_.elements.size() > 1)
            cut_.surface.scale_of_patch.push_back(
                static_cast<std::uint8_t>(grids_.elements.size() - 1 - level));
        elements_.push_back(polygon);
    }

    /// Cells of the finest grid.
    struct Block {
        std::uint32_t column, row, width, height;
    };

    Block block(const Surface& grid, std::uint32_t cell) const {
        const std::uint32_t width = cut_.surface.columns / grid.columns;
        const std::uint32_t height = cut_.surface.rows / grid.rows;
        return {cell % grid.columns * width, cell / grid.columns * height, width, height};
    }

    bool is_deeper(const Depths& depths, std::size_t than, const Block& block) const {
        if (depths.empty()) return false;
        for (std::uint32_t y = block.row; y < block.row + block.height; ++y)
            for (std::uint32_t x = block.column; x < block.column + block.width; ++x)
                if (depths[std::size_t{y} * cut_.surface.columns + x] > than) return true;
        return false;
    }

    Grids grids_;
    Precision precision_;
    VertexWelder& vertices_;
    PolygonSplitter splitter_;
    double slack_;
    ContactGrid contacts_;
    std::vector<Contact> contacts_here_;  ///< of the cell that is being filled
    std::vector<SidePiece> pieces_;       ///< of a surface that has contacts
    ContactMarks marks_;
    CutSurface cut_;
    std::vector<Polygon> elements_;  ///< of the patches that are being added
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
    const double width = surface.columns * surface.cell_size.x;
    for (auto& [from, to] : surface.walls) {
        from.x = width - from.x;
        to.x = width - to.x;
    }
    for (std::uint32_t i = 0; i < surface.cell_of_patch.size(); ++i) {
        std::uint32_t& cell = surface.cell_of_patch[i];
        cell += surface.columns - (1u << surface.scale(i)) - 2 * (cell % surface.columns);
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
    for (const auto& [corners, surface, first_patch, patch_count, splits] : cut.shooters)
        mesh.shooters.push_back(
            {corners, index, cut.surface.first_patch + first_patch, patch_count, splits});
    for (const auto& [face, patch, area] : cut.fragments)
        mesh.fragments.push_back({face, cut.surface.first_patch + patch, area});
    mesh.surfaces.push_back(std::move(cut.surface));
}

}  // namespace hemirad::meshing
