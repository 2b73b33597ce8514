#include "scene/find_sides.h"

#include <algorithm>
#include <utility>

#include "scene/disjoint_sets.h"
#include "scene/edges.h"

namespace hemirad::meshing {
namespace {

/// Values are blended over neighbouring cells of every scale: over less than two cells of the
/// largest in all.
constexpr std::int64_t kReach = 2;

void join_over_vertices(const std::vector<SidePiece>& pieces, const ContactMarks& marks,
                        DisjointSets& regions) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex;
    for (std::uint32_t p = 0; p < pieces.size(); ++p)
        for (const std::uint32_t corner : pieces[p].corners)
            if (!marks.is_on_contact(corner)) at_vertex.emplace_back(corner, p);
    std::ranges::sort(at_vertex);
    for (std::size_t i = 1; i < at_vertex.size(); ++i)
        if (at_vertex[i].first == at_vertex[i - 1].first)
            regions.join(at_vertex[i].second, at_vertex[i - 1].second);
}

void join_over_edges(const std::vector<SidePiece>& pieces, const ContactMarks& marks,
                     DisjointSets& regions) {
    std::vector<Edge> edges;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const auto& corners = pieces[p].corners;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
            if (marks.is_on_contact(a) && marks.is_on_contact(b) && !marks.runs_along_contact(a, b))
                edges.emplace_back(a, b, p);
        }
    }
    sort_edges(edges);
    for_each_shared(edges, [&](std::span<const Edge> shared) {
        for (const Edge& edge : shared) regions.join(edge.owner, shared[0].owner);
    });
}

/// A block of cells as large as the largest that a patch has, and a region in it.
struct Presence {
    std::int64_t row, column;
    std::uint32_t region;
    auto operator<=>(const Presence&) const = default;
};

std::vector<Presence> presences(const std::vector<SidePiece>& pieces, const Surface& surface,
                                DisjointSets& regions) {
    const std::uint32_t scale =
        surface.scale_of_patch.empty() ? 0 : std::ranges::max(surface.scale_of_patch);
    std::vector<Presence> present;
    for (std::uint32_t p = 0; p < pieces.size(); ++p)
        for (std::uint32_t i = 0; i < pieces[p].patch_count; ++i) {
            const std::uint32_t cell = surface.cell_of_patch[pieces[p].first_patch + i];
            present.push_back({(cell / surface.columns) >> scale, (cell % surface.columns) >> scale,
                               regions.find(p)});
        }
    std::ranges::sort(present);
    const auto repeated = std::ranges::unique(present);
    present.erase(repeated.begin(), repeated.end());
    return present;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The region that is in the most blocks: that of all which no contact surrounds.
std::uint32_t most_common(std::vector<Presence> present) {
    std::ranges::sort(present, {}, &Presence::region);
    std::uint32_t most = 0;
    for (std::size_t begin = 0, end = 0, longest = 0; begin < present.size(); begin = end) {
        while (end < present.size() && present[end].region == present[begin].region) ++end;
        if (end - begin > longest) most = present[begin].region;
        longest = std::max(longest, end - begin);
    }
    return most;
}

// Both ways.
Pairs near_each_other(const std::vector<Presence>& present) {
    const std::uint32_t common = most_common(present);
    Pairs pairs;
    for (const auto& [at_row, at_column, region] : present) {
        if (region == common) continue;
        for (std::int64_t row = at_row - kReach; row <= at_row + kReach; ++row) {
            auto near = std::ranges::lower_bound(present, Presence{row, at_column - kReach, 0});
            for (; near != present.end() && near->row == row && near->column <= at_column + kReach;
                 ++near)
                if (near->region != region)
                    pairs.insert(pairs.end(), {{region, near->region}, {near->region, region}});
        }
    }
    std::ranges::sort(pairs);
    const auto repeated = std::ranges::unique(pairs);
    pairs.erase(repeated.begin(), repeated.end());
    return pairs;
}

// The lowest that no lower region near it has; the last stands for all beyond.
std::uint8_t free_side(std::uint32_t region, const Pairs& pairs,
                       const std::vector<std::uint8_t>& sides) {
    constexpr std::uint8_t kMost = 255;
    std::set<std::uint8_t> taken;
    for (const auto& [here, there] : std::ranges::equal_range(
             pairs, region, {}, &std::pair<std::uint32_t, std::uint32_t>::first))
        if (there < here) taken.insert(sides[there]);
    std::uint8_t side = 0;
    while (side < kMost && taken.contains(side)) ++side;
    return side;
}

}  // namespace

void ContactMarks::add(const Polygon& piece, const std::vector<Contact>& contacts, double slack) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Corner &a = piece[i], &b = piece[(i + 1) % piece.size()];
        for (const Contact& contact : contacts) {
            if (distance(contact, a.at) <= slack) vertices_.insert(a.vertex);
            if (runs_along(contact, a.at, b.at, slack))
                edges_.insert(std::minmax(a.vertex, b.vertex));
        }
    }
}

bool ContactMarks::runs_along_contact(std::uint32_t a, std::uint32_t b) const {
    return edges_.contains(std::minmax(a, b));
}

std::vector<std::uint8_t> find_sides(const std::vector<SidePiece>& pieces, const Surface& surface,
                                     const ContactMarks& marks) {
    DisjointSets regions(pieces.size());
    join_over_vertices(pieces, marks, regions);
    join_over_edges(pieces, marks, regions);
    const Pairs pairs = near_each_other(presences(pieces, surface, regions));
    std::vector<std::uint8_t> of_piece(pieces.size(), 0), of_patch;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const std::uint32_t region = regions.find(p);  // its lowest piece
        of_piece[p] = region == p ? free_side(region, pairs, of_piece) : of_piece[region];
        of_patch.insert(of_patch.end(), pieces[p].patch_count, of_piece[p]);
    }
    if (std::ranges::all_of(of_patch, [](std::uint8_t side) { return side == 0; }))
        of_patch.clear();
    return of_patch;
}

}  // namespace hemirad::meshing
