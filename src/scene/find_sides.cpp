#include "scene/find_sides.h"

#include <algorithm>
#include <bitset>
#include <optional>
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

/// The last side stands for all beyond.
constexpr std::uint8_t kLastSide = 255;
using SidesTaken = std::bitset<kLastSide>;

/// What regions have taken in a block so far, all but the most common.
struct Block {
    std::int64_t row, column;
    bool holds_common = false;
    SidesTaken taken = {};

    auto place() const { return std::pair(row, column); }
};

std::uint8_t free_side(const SidesTaken& taken) {
    std::uint8_t side = 0;
    while (side < kLastSide && taken.test(side)) ++side;
    return side;
}

/// Gives regions, lowest first, the lowest side that none near them has. Each looks at the blocks
/// about its own, however many regions these hold; the most common one, which is about everywhere,
/// is looked for instead.
class SideChooser {
  public:
    explicit SideChooser(std::vector<Presence> present)
        : common_(most_common(present)), present_(std::move(present)) {
        for (const auto& [row, column, region] : present_) {
            if (blocks_.empty() || blocks_.back().place() != std::pair(row, column))
                blocks_.push_back({row, column});
            blocks_.back().holds_common |= region == common_;
        }
        std::ranges::stable_sort(present_, {}, &Presence::region);
    }

    std::uint8_t choose(std::uint32_t region) {
        if (region == common_) return *(common_side_ = free_side(taken_about_common_));
        const auto own = std::ranges::equal_range(present_, region, {}, &Presence::region);
        SidesTaken taken;
        bool meets_common = false;
        for (const Presence& at : own)
            for_each_block_about(at, [&](const Block& block) {
                taken |= block.taken;
                meets_common |= block.holds_common;
            });
        if (meets_common && common_side_) take(*common_side_, taken);
        const std::uint8_t side = free_side(taken);
        for (const Presence& at : own) take(side, find(at.row, at.column)->taken);
        if (meets_common) take(side, taken_about_common_);
        return side;
    }

  private:
    static void take(std::uint8_t side, SidesTaken& taken) {
        if (side < kLastSide) taken.set(side);
    }
    std::vector<Block>::iterator find(std::int64_t row, std::int64_t column) {
        return std::ranges::lower_bound(blocks_, std::pair(row, column), {}, &Block::place);
    }
    template <class Visit>
    void for_each_block_about(const Presence& at, Visit visit) {
        for (std::int64_t row = at.row - kReach; row <= at.row + kReach; ++row)
            for (auto block = find(row, at.column - kReach);
                 block != blocks_.end() && block->row == row && block->column <= at.column + kReach;
                 ++block)
                visit(*block);
    }

    std::uint32_t common_;
    std::vector<Presence> present_;  ///< by region
    std::vector<Block> blocks_;      ///< by place
    SidesTaken taken_about_common_;
    std::optional<std::uint8_t> common_side_;
};

}  // namespace

void ContactMarks::add(const Polygon& piece, const std::vector<Contact>& contacts, double slack) {
    const auto near = about(piece, contacts, slack);
    for (std::size_t i = 0; i < piece.size(); ++i) {
        const Corner &a = piece[i], &b = piece[(i + 1) % piece.size()];
        for (const Contact& contact : near) {
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
    SideChooser sides(presences(pieces, surface, regions));
    std::vector<std::uint8_t> of_piece(pieces.size(), 0), of_patch;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const std::uint32_t region = regions.find(p);  // its lowest piece
        of_piece[p] = region == p ? sides.choose(region) : of_piece[region];
        of_patch.insert(of_patch.end(), pieces[p].patch_count, of_piece[p]);
    }
    if (std::ranges::all_of(of_patch, [](std::uint8_t side) { return side == 0; }))
        of_patch.clear();
    return of_patch;
}

}  // namespace hemirad::meshing
