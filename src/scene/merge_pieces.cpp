#include "scene/merge_pieces.h"

#include <algorithm>
#include <optional>
#include <set>

#include "scene/disjoint_sets.h"
#include "scene/edges.h"

namespace hemirad::meshing {
namespace {

/// An edge between the pieces `left` and `right`, in the direction in which `left` has it.
struct SharedEdge {
    std::uint32_t from, to;
    std::uint32_t left, right;
};

/// How the pieces of a cell hang together.
struct Seams {
    std::vector<SharedEdge> shared;
    std::vector<SharedEdge> barred;  ///< shared by what must not be joined
    std::vector<Edge> outer;         ///< with both directions of the barred ones
};

Seams find_seams(std::span<const CellPiece> cell, const Barriers& barriers) {
    std::vector<Edge> edges;
    std::set<std::uint64_t> barred;
    for (std::uint32_t p = 0; p < cell.size(); ++p) {
        const Polygon& polygon = cell[p].polygon;
        const auto contacts = about(polygon, barriers.contacts, barriers.slack);
        const Barriers near{contacts, barriers.slack};
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Corner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            edges.emplace_back(a.vertex, b.vertex, p);
            if (near.part(a, b)) barred.insert(edges.back().key);
        }
    }
    sort_edges(edges);
    Seams seams;
    for_each_shared(edges, [&](std::span<const Edge> same) {
        const bool shared = same.size() == 2 && same[0].ascending != same[1].ascending;
        const bool joins = shared && !barred.contains(same[0].key);
        if (shared)
            (joins ? seams.shared : seams.barred)
                .push_back({same[0].from(), same[0].to(), same[0].owner, same[1].owner});
        if (!joins) seams.outer.insert(seams.outer.end(), same.begin(), same.end());
    });
    return seams;
}

// The closed loop that the edges form; empty if they form several or branch.
std::vector<std::uint32_t> trace(std::vector<Edge> edges) {
    if (edges.empty()) return {};
    std::ranges::sort(edges, {}, &Edge::from);
    const auto next = [&](std::uint32_t vertex) {
        return std::ranges::equal_range(edges, vertex, {}, &Edge::from);
    };
    std::vector<std::uint32_t> loop;
    std::uint32_t vertex = edges.front().from();
    do {
        const auto leaving = next(vertex);
        if (leaving.size() != 1 || loop.size() == edges.size()) return {};
        loop.push_back(vertex);
        vertex = leaving.front().to();
    } while (vertex != loop.front());
    if (loop.size() != edges.size()) return {};
    return loop;
}

Polygon with_positions(const std::vector<std::uint32_t>& loop, std::span<const CellPiece> cell,
                       const std::vector<std::uint32_t>& pieces) {
    std::vector<Corner> known;
    for (const std::uint32_t p : pieces)
        known.insert(known.end(), cell[p].polygon.begin(), cell[p].polygon.end());
    std::ranges::sort(known, {}, &Corner::vertex);
    Polygon polygon;
    for (const std::uint32_t vertex : loop)
        polygon.push_back(*std::ranges::lower_bound(known, vertex, {}, &Corner::vertex));
    return polygon;
}

// a then b, each without the edge from..to they share; tips of spikes where they share more.
Polygon join(const Polygon& a, const Polygon& b, const SharedEdge& edge) {
    Polygon joined;
    const auto append = [&](const Polygon& polygon, std::uint32_t first) {
        const auto at = std::ranges::find(polygon, first, &Corner::vertex) - polygon.begin();
        for (std::size_t i = 0; i + 1 < polygon.size(); ++i)
            joined.push_back(polygon[(static_cast<std::size_t>(at) + i) % polygon.size()]);
    };
    append(a, edge.to);
    append(b, edge.from);
    for (std::size_t i = 0, kept = 0; joined.size() > 2 && kept < joined.size();) {
        const std::size_t n = joined.size();
        const bool spike = joined[(i + n - 1) % n].vertex == joined[(i + 1) % n].vertex;
        const bool repeated = joined[i].vertex == joined[(i + 1) % n].vertex;
        kept = spike || repeated ? 0 : kept + 1;
        if (spike || repeated)
            joined.erase(joined.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
        i %= joined.size();
    }
    return joined;
}

/// Joins pairs while their union stays convex (Hertel and Mehlhorn 1983, from the pieces up).
class PairwiseMerge {
  public:
    PairwiseMerge(std::span<const CellPiece> cell, const std::vector<std::uint32_t>& pieces,
                  double precision)
        : sets_(cell.size()), outlines_(cell.size()), precision_(precision) {
        for (const std::uint32_t p : pieces) outlines_[p] = cell[p].polygon;
    }

    void run(std::span<const SharedEdge> shared, std::span<const SharedEdge> barred) {
        for (bool joined = true; joined;) {
            joined = false;
            for (const SharedEdge& edge : shared) joined |= try_join(edge, barred);
        }
    }

    std::vector<MergedPiece> take(const std::vector<std::uint32_t>& pieces) {
        std::vector<std::vector<std::uint32_t>> members(outlines_.size());
        for (const std::uint32_t p : pieces) members[sets_.find(p)].push_back(p);
        std::vector<MergedPiece> merged;
        for (const std::uint32_t p : pieces)
            if (!members[p].empty())
                merged.push_back({without_straight_corners(outlines_[p], precision_), members[p]});
        return merged;
    }

  private:
    bool try_join(const SharedEdge& edge, std::span<const SharedEdge> barred) {
        // Keeps each attempt cheap where a cell holds thousands of tiny faces.
        constexpr std::size_t kLongestOutline = 64;
        const std::uint32_t left = sets_.find(edge.left);
        const std::uint32_t right = sets_.find(edge.right);
        if (left == right || are_parted(left, right, barred)) return false;
        if (outlines_[left].size() + outlines_[right].size() > kLongestOutline) return false;
        Polygon joined = join(outlines_[left], outlines_[right], edge);
        if (!is_convex(without_straight_corners(joined, precision_))) return false;
        sets_.join(left, right);
        outlines_[std::min(left, right)] = std::move(joined);
        return true;
    }

    bool are_parted(std::uint32_t a, std::uint32_t b, std::span<const SharedEdge> barred) {
        return std::ranges::any_of(barred, [&](const SharedEdge& edge) {
            const std::uint32_t left = sets_.find(edge.left), right = sets_.find(edge.right);
            return (left == a && right == b) || (left == b && right == a);
        });
    }

    DisjointSets sets_;
    std::vector<Polygon> outlines_;
    double precision_;
};

/// One connected component of a cell's pieces.
struct Component {
    std::vector<std::uint32_t> pieces;
    std::vector<SharedEdge> shared, barred;
    std::vector<Edge> outer;
};

std::vector<Component> find_components(std::span<const CellPiece> cell, const Seams& seams) {
    DisjointSets sets(cell.size());
    for (const SharedEdge& edge : seams.shared) sets.join(edge.left, edge.right);
    std::vector<Component> at_root(cell.size());
    for (std::uint32_t p = 0; p < cell.size(); ++p) at_root[sets.find(p)].pieces.push_back(p);
    for (const SharedEdge& edge : seams.shared)
        at_root[sets.find(edge.left)].shared.push_back(edge);
    for (const SharedEdge& edge : seams.barred)
        at_root[sets.find(edge.left)].barred.push_back(edge);
    for (const Edge& edge : seams.outer) at_root[sets.find(edge.owner)].outer.push_back(edge);
    std::erase_if(at_root, [](const Component& component) { return component.pieces.empty(); });
    return at_root;
}

std::optional<MergedPiece> merge_whole(std::span<const CellPiece> cell, const Component& component,
                                       double precision) {
    const auto loop = trace(component.outer);
    if (loop.empty()) return {};
    Polygon polygon =
        without_straight_corners(with_positions(loop, cell, component.pieces), precision);
    if (!is_convex(polygon)) return {};
    return MergedPiece{std::move(polygon), component.pieces};
}

}  // namespace

bool Barriers::part(const Corner& a, const Corner& b) const {
    return std::ranges::any_of(
        contacts, [&](const Contact& contact) { return runs_along(contact, a.at, b.at, slack); });
}

std::vector<MergedPiece> merge_pieces(std::span<const CellPiece> cell, double precision,
                                      const Barriers& barriers) {
    if (cell.size() == 1) return {{without_straight_corners(cell.front().polygon, precision), {0}}};
    std::vector<MergedPiece> merged;
    for (const Component& component : find_components(cell, find_seams(cell, barriers))) {
        if (auto whole = merge_whole(cell, component, precision)) {
            merged.push_back(std::move(*whole));
            continue;
        }
        PairwiseMerge pairs(cell, component.pieces, precision);
        pairs.run(component.shared, component.barred);
        for (MergedPiece& piece : pairs.take(component.pieces)) merged.push_back(std::move(piece));
    }
    return merged;
}

}  // namespace hemirad::meshing
