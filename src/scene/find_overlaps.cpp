#include "scene/find_overlaps.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "scene/face_warnings.h"
#include "scene/frame.h"
#include "scene/polygon.h"

namespace hemirad::meshing {
namespace {

struct Box {
    glm::dvec2 low = glm::dvec2(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;

    double longest_side() const { return std::max(high.x - low.x, high.y - low.y); }
    bool meets(const Box& other, double precision) const {
        return std::min(high.x, other.high.x) - std::max(low.x, other.low.x) > precision &&
               std::min(high.y, other.high.y) - std::max(low.y, other.low.y) > precision;
    }
};

struct Piece {
    std::uint32_t surface, patch;
    Box box;
};

/// The fronts of one plane that face one way, cut into their patches.
class Layer {
  public:
    Layer(const Mesh& mesh, double precision, const std::vector<std::uint32_t>& surfaces)
        : mesh_(mesh), precision_(precision) {
        const Surface& first = mesh.surfaces[surfaces.front()];
        frame_ = {first.origin, first.u_axis, first.v_axis, first.normal};
        for (const std::uint32_t s : surfaces) {
            const Surface& surface = mesh.surfaces[s];
            for (std::uint32_t i = 0; i < surface.patch_count; ++i)
                pieces_.push_back(piece_of(surface.first_patch + i));
        }
        std::ranges::stable_sort(pieces_, std::greater{},
                                 [](const Piece& piece) { return piece.box.longest_side(); });
    }

    // Large ones first, each into the cells of a grid that is as wide as they are, of which it
    // touches four at most. So a piece meets all that are no smaller in the cells about it.
    void find(Overlaps& overlaps) {
        std::int64_t left = kFewestLooks + kLooksAPiece * std::ssize(pieces_);
        for (std::uint32_t p = 0; p < pieces_.size() && left > 0; ++p) {
            const Box& box = pieces_[p].box;
            std::set<std::uint32_t> near;
            for (const int level : levels_)
                for_each_cell(level, box, [&](const Cell& cell) {
                    const auto found = cells_.find(cell);
                    if (found == cells_.end()) return;
                    left -= std::ssize(found->second);
                    for (const std::uint32_t q : found->second)
                        if (left > 0 && may_overlap(p, q)) near.insert(q);
                });
            for (const std::uint32_t q : near) add(p, q);
            const int level = level_of(box.longest_side());
            levels_.insert(level);
            for_each_cell(level, box, [&](const Cell& cell) { cells_[cell].push_back(p); });
        }
        if (left <= 0) overlaps.complete = false;
        for (const auto& [surfaces, overlap] : found_) overlaps.pairs.push_back(overlap);
    }

  private:
    // A look takes some ten nanoseconds, a grid of tiles needs some twenty a piece.
    static constexpr std::int64_t kFewestLooks = 1000000, kLooksAPiece = 100;
    struct Cell {
        int level;
        std::int64_t column, row;
        auto operator<=>(const Cell&) const = default;
    };

    Piece piece_of(std::uint32_t index) const {
        const Patch& patch = mesh_.patches[index];
        Piece piece{patch.surface, index, {}};
        for (const std::uint32_t corner : patch.corners) {
            const glm::dvec2 at = frame_.project(mesh_.vertices[corner]);
            piece.box.low = glm::min(piece.box.low, at);
            piece.box.high = glm::max(piece.box.high, at);
        }
        return piece;
    }
    Polygon polygon_of(const Piece& piece) const {
        const Patch& patch = mesh_.patches[piece.patch];
        Polygon polygon;
        for (int i = 0; i < (patch.is_triangle() ? 3 : 4); ++i)
            polygon.push_back({patch.corners[i], frame_.project(mesh_.vertices[patch.corners[i]])});
        return polygon;
    }

    static int level_of(double side) { return std::ilogb(side) + 1; }

    template <class Visit>
    static void for_each_cell(int level, const Box& box, Visit visit) {
        const double size = std::ldexp(1.0, level);
        const auto index = [&](double at) { return std::int64_t(std::floor(at / size)); };
        for (auto row = index(box.low.y); row <= index(box.high.y); ++row)
            for (auto column = index(box.low.x); column <= index(box.high.x); ++column)
                visit(Cell{level, column, row});
    }

    bool may_overlap(std::uint32_t p, std::uint32_t q) const {
        return pieces_[p].surface != pieces_[q].surface &&
               pieces_[p].box.meets(pieces_[q].box, precision_);
    }

    void add(std::uint32_t p, std::uint32_t q) {
        const double area = common_area(polygon_of(pieces_[p]), polygon_of(pieces_[q]));
        const double side = std::min(pieces_[p].box.longest_side(), pieces_[q].box.longest_side());
        if (area <= precision_ * side) return;
        const auto [lower, higher] = std::minmax(pieces_[p].surface, pieces_[q].surface);
        Overlap& overlap =
            found_.try_emplace({lower, higher}, Overlap{lower, higher, 0, {}}).first->second;
        if (overlap.area == 0) overlap.at = place_in(pieces_[p].box, pieces_[q].box);
        overlap.area += area;
    }
    glm::dvec3 place_in(const Box& a, const Box& b) const {
        const glm::dvec2 middle = 0.5 * (glm::max(a.low, b.low) + glm::min(a.high, b.high));
        return frame_.origin + middle.x * frame_.u + middle.y * frame_.v;
    }

    const Mesh& mesh_;
    double precision_;
    Frame frame_;
    std::vector<Piece> pieces_;
    std::set<int> levels_;
    std::map<Cell, std::vector<std::uint32_t>> cells_;
    std::map<std::pair<std::uint32_t, std::uint32_t>, Overlap> found_;
};

/// Fronts by plane, and by which of its sides they are on.
using Layers = std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>>;

Layers layers_of(const Mesh& mesh) {
    std::map<std::uint32_t, std::uint32_t> first_of_plane;
    Layers layers;
    for (std::uint32_t s = 0; s < mesh.surfaces.size(); ++s) {
        const Surface& surface = mesh.surfaces[s];
        if (surface.is_back) continue;
        const auto first = first_of_plane.try_emplace(surface.plane, s).first->second;
        const bool up = glm::dot(mesh.surfaces[first].normal, surface.normal) > 0;
        layers[{surface.plane, up}].push_back(s);
    }
    return layers;
}

std::string described(const Overlap& overlap, const Mesh& mesh) {
    const auto name = [&](std::uint32_t surface) {
        return '"' + mesh.objects[mesh.surfaces[surface].object] + '"';
    };
    std::ostringstream line;
    line.precision(3);
    line << "faces of " << name(overlap.lower) << " and " << name(overlap.higher) << " overlap at "
         << place_text(overlap.at) << " by " << overlap.area << " m^2: both are kept";
    return line.str();
}

}  // namespace

Overlaps find_overlaps(const Mesh& mesh, const Precision& precision) {
    Overlaps overlaps;
    for (const auto& [plane, surfaces] : layers_of(mesh))
        if (surfaces.size() > 1) Layer(mesh, precision.plane, surfaces).find(overlaps);
    std::ranges::sort(overlaps.pairs, {}, [](const Overlap& overlap) {
        return std::pair(overlap.lower, overlap.higher);
    });
    return overlaps;
}

std::vector<std::string> warnings_of(const Overlaps& overlaps, const std::string& file,
                                     const Mesh& mesh) {
    constexpr std::size_t kInFull = 5;
    std::vector<std::string> warnings;
    const auto& pairs = overlaps.pairs;
    for (std::size_t i = 0; i < std::min(pairs.size(), kInFull); ++i)
        warnings.push_back(file + ": " + described(pairs[i], mesh));
    if (pairs.size() > kInFull)
        warnings.push_back(file + ": and " + std::to_string(pairs.size() - kInFull) +
                           " more overlaps: both faces are kept");
    if (!overlaps.complete)
        warnings.push_back(file + ": too many faces side by side to look for all that overlap");
    return warnings;
}

}  // namespace hemirad::meshing
