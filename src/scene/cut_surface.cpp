#include "scene/cut_surface.h"

#include <numeric>
#include <utility>

#include "scene/cut_cells.h"
#include "scene/merge_pieces.h"
#include "scene/polygon.h"

namespace hemirad::meshing {
namespace {

using Cell = std::span<const CellPiece>;

Patch patch_of(const Polygon& polygon) {
    return {{polygon[0].vertex, polygon[1].vertex, polygon[2].vertex, polygon.back().vertex}, 0};
}

// Shares a piece's area out to the patches that its merged polygon was cut into. Shares add up to
// the whole piece, also where straight corners that were left out had moved the outline a little.
void share_out(const CellPiece& piece, const std::vector<Polygon>& parts, std::uint32_t first_patch,
               std::vector<Fragment>& fragments) {
    std::vector<double> shares{1.0};
    if (parts.size() > 1) {
        shares.clear();
        for (const Polygon& part : parts) shares.push_back(common_area(piece.polygon, part));
    }
    const double total = std::accumulate(shares.begin(), shares.end(), 0.0);
    if (total <= 0) return;
    const double whole = area(piece.polygon);
    for (std::uint32_t i = 0; i < parts.size(); ++i)
        if (shares[i] > 0)
            fragments.push_back({piece.face, first_patch + i, whole * shares[i] / total});
}

void add_patches(const MergedPiece& merged, Cell cell, double precision, CutSurface& cut) {
    const auto parts = cut_into_quads(merged.polygon, precision);
    const auto first_patch = static_cast<std::uint32_t>(cut.patches.size());
    for (const Polygon& part : parts) {
        cut.patches.push_back(patch_of(part));
        cut.surface.cell_of_patch.push_back(cell.front().cell);
    }
    if (parts.empty()) return;
    for (const std::uint32_t piece : merged.pieces)
        share_out(cell[piece], parts, first_patch, cut.fragments);
}

std::vector<MergedPiece> unmerged(Cell cell, double precision) {
    std::vector<MergedPiece> pieces;
    for (std::uint32_t p = 0; p < cell.size(); ++p)
        pieces.push_back({without_straight_corners(cell[p].polygon, precision), {p}});
    return pieces;
}

}  // namespace

CutSurface cut_surface(const FlatFaces& faces, const Group& group, Surface surface, Merging merging,
                       const Precision& precision, VertexWelder& vertices) {
    CutSurface cut{std::move(surface), {}, {}};
    const auto pieces = cut_into_cells(faces, group, cut.surface, precision, vertices);
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
        while (end < pieces.size() && pieces[end].cell == pieces[begin].cell) ++end;
        const Cell cell(&pieces[begin], end - begin);
        const auto polygons = merging == Merging::none ? unmerged(cell, precision.plane)
                                                       : merge_pieces(cell, precision.plane);
        for (const MergedPiece& merged : polygons)
            if (merged.polygon.size() > 2) add_patches(merged, cell, precision.plane, cut);
    }
    return cut;
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
    for (Patch& patch : cut.patches) {
        const auto [a, b, c, d] = patch.corners;
        patch.corners = patch.is_triangle() ? std::array{a, c, b, b} : std::array{a, d, c, b};
    }
    cut.fragments.clear();
    return cut;
}

void append(CutSurface cut, Mesh& mesh) {
    if (cut.patches.empty()) return;
    cut.surface.first_patch = static_cast<std::uint32_t>(mesh.patches.size());
    cut.surface.patch_count = static_cast<std::uint32_t>(cut.patches.size());
    for (Patch& patch : cut.patches) {
        patch.surface = static_cast<std::uint32_t>(mesh.surfaces.size());
        mesh.patches.push_back(patch);
    }
    for (const auto& [face, patch, area] : cut.fragments)
        mesh.fragments.push_back({face, cut.surface.first_patch + patch, area});
    mesh.surfaces.push_back(std::move(cut.surface));
}

}  // namespace hemirad::meshing
