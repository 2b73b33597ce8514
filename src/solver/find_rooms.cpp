#include "solver/find_rooms.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>

#include "scene/bounds.h"
#include "solver/enclosure.h"
#include "solver/join_sides.h"

namespace hemirad {
namespace {

/// Bounds the time, a second or so.
constexpr std::size_t kMostLooks = 300'000'000;
// A million take 13 s and 150 bytes a patch.
constexpr std::size_t kMostPatches = 1u << 18;

constexpr std::uint32_t kOwnBits = 31;  // of a word; the last bit is the others'

/// Sides that hang together over edges.
struct Shell {
    std::vector<std::uint32_t> sides;  ///< the largest patch's first
    Bounds bounds;
    glm::dvec3 base{};
    double area = 0;
    double volume = 0;  ///< that it has within, negative where it has all else
    bool has_fronts = false;

    /// `play` is what the two sides of one sheet may lie apart by.
    bool encloses(double play) const { return volume > play * area; }
    /// The space that it bounds is full, or has no extent.
    bool is_solid(double play) const { return !has_fronts && volume > -play * area; }
};

bool holds(const Bounds& bounds, const glm::dvec3& point) {
    return glm::all(glm::greaterThanEqual(point, bounds.least)) &&
           glm::all(glm::lessThanEqual(point, bounds.most));
}

bool meet(const Bounds& a, const Bounds& b) {
    return glm::all(glm::lessThanEqual(a.least, b.most)) &&
           glm::all(glm::lessThanEqual(b.least, a.most));
}

class RoomFinder {
  public:
    explicit RoomFinder(const Mesh& mesh)
        : mesh_(mesh),
          vertices_(merged_vertices(mesh)),
          play_(4 * mesh.weld),
          shell_of_(2 * mesh.patches.size()),
          rooms_(0) {}

    Rooms run() {
        list_shells();
        rooms_ = meshing::DisjointSets(shells_.size() + 1);
        list_enclosing();
        if (lit_.empty() || !place_shells()) return {};
        return rooms();
    }

  private:
    /// What is in no room: a shell of its own.
    std::uint32_t outside() const { return static_cast<std::uint32_t>(shells_.size()); }

    void list_shells() {
        auto sides = join_sides(mesh_, vertices_);
        std::vector<std::uint32_t> shell_of_root(shell_of_.size(), kAllRooms);
        for (std::uint32_t side = 0; side < shell_of_.size(); ++side) {
            std::uint32_t& shell = shell_of_root[sides.find(side)];
            if (shell == kAllRooms) {
                shell = static_cast<std::uint32_t>(shells_.size());
                shells_.emplace_back();
            }
            shell_of_[side] = shell;
            add(side, shells_[shell]);
        }
    }

    // Divergence theorem, from a point near to lose no digits.
    void add(std::uint32_t side, Shell& shell) const {
        const Patch& patch = mesh_.patches[side / 2];
        const double area = mesh_.area(patch), sign = side % 2 == 0 ? -1 : 1;
        if (shell.sides.empty()) shell.base = mesh_.vertices[patch.corners[0]];
        const glm::dvec3 away = mesh_.vertices[patch.corners[0]] - shell.base;
        shell.volume += sign * area * glm::dot(away, mesh_.normal(patch)) / 3;
        shell.area += area;
        shell.has_fronts |= side % 2 == 0;
        for (const std::uint32_t corner : patch.corners)
            shell.bounds.take_in(mesh_.vertices[corner]);
        shell.sides.push_back(side);
        if (area > mesh_.area(mesh_.patches[shell.sides[0] / 2]))
            std::swap(shell.sides.front(), shell.sides.back());
    }

    // The smallest first: of several around a point, it is the one that counts.
    void list_enclosing() {
        for (std::uint32_t shell = 0; shell < shells_.size(); ++shell)
            if (shells_[shell].encloses(play_)) enclosing_.push_back(shell);
        std::ranges::sort(enclosing_, {},
                          [&](std::uint32_t shell) { return shells_[shell].volume; });
        std::ranges::copy_if(enclosing_, std::back_inserter(lit_),
                             [&](std::uint32_t shell) { return shells_[shell].has_fronts; });
    }

    bool place_shells() {
        for (std::uint32_t shell = 0; shell < shells_.size(); ++shell) {
            if (looks_ > kMostLooks) return false;
            if (shells_[shell].has_fronts)
                place(shell);
            else if (!shells_[shell].is_solid(play_))
                place_backs(shell);
        }
        return true;
    }

    // Just before the middle of a patch.
    glm::dvec3 point_at(std::uint32_t side) const {
        const Patch& patch = mesh_.patches[side / 2];
        const double away = std::max(8 * mesh_.weld, 1e-6 * std::sqrt(mesh_.area(patch)));
        return mesh_.centroid(patch) + (side % 2 == 0 ? away : -away) * mesh_.normal(patch);
    }

    bool holds_point(std::uint32_t shell, const glm::dvec3& point) {
        ++looks_;
        if (!holds(shells_[shell].bounds, point)) return false;
        const auto [at, is_new] = enclosures_.try_emplace(shell);
        if (is_new) at->second.emplace(mesh_, vertices_, shells_[shell].sides);
        const std::size_t before = at->second->looks();
        const bool holds = at->second->holds(point);
        looks_ += at->second->looks() - before;
        return holds;
    }

    // Point by point, as it may stick out of one room into another, which then are one. Solids that
    // hold a part of it do not hide it.
    void place(std::uint32_t shell) {
        std::vector<glm::dvec3> points;
        for (const std::uint32_t side : shells_[shell].sides) points.push_back(point_at(side));
        const bool is_room = shells_[shell].encloses(play_);
        for (const std::uint32_t other : lit_) {
            ++looks_;
            if (other == shell || !meet(shells_[other].bounds, shells_[shell].bounds)) continue;
            const auto held = std::ranges::partition(
                points, [&](const glm::dvec3& point) { return !holds_point(other, point); });
            if (held.empty() || (is_room && held.size() == points.size())) continue;
            rooms_.join(shell, other);
            points.erase(held.begin(), held.end());
        }
        if (!is_room && !points.empty()) rooms_.join(shell, outside());
    }

    // Nothing but backs: no light unless there is some in what is around.
    void place_backs(std::uint32_t shell) {
        const glm::dvec3 point = point_at(shells_[shell].sides.front());
        const auto around = std::ranges::find_if(
            enclosing_, [&](std::uint32_t other) { return holds_point(other, point); });
        rooms_.join(shell, around != enclosing_.end() ? *around : outside());
    }

    std::uint32_t room_at(std::uint32_t side) { return rooms_.find(shell_of_[side]); }

    // The largest have bits of their own.
    std::map<std::uint32_t, std::uint32_t> bits() {
        std::map<std::uint32_t, double> areas;
        for (std::uint32_t patch = 0; patch < mesh_.patches.size(); ++patch)
            areas[room_at(front_of(patch))] += mesh_.area(mesh_.patches[patch]);
        std::vector<std::pair<std::uint32_t, double>> order(areas.begin(), areas.end());
        std::ranges::stable_sort(order, std::ranges::greater{},
                                 &std::pair<std::uint32_t, double>::second);
        std::map<std::uint32_t, std::uint32_t> bits;
        for (std::uint32_t i = 0; i < order.size(); ++i)
            bits[order[i].first] = 1u << std::min(i, kOwnBits);
        return bits;
    }

    using Passages = std::set<std::pair<std::uint32_t, std::uint32_t>>;

    // Through the backs of patches, from rooms that have light to reflect.
    Passages passages(const std::map<std::uint32_t, std::uint32_t>& bits) {
        Passages passages;
        for (std::uint32_t patch = 0; patch < mesh_.patches.size(); ++patch) {
            const std::uint32_t from = room_at(back_of(patch)), to = room_at(front_of(patch));
            if (from != to && bits.contains(from)) passages.emplace(from, to);
        }
        return passages;
    }

    static std::set<std::uint32_t> reached_from(std::uint32_t room, const Passages& passages) {
        std::set<std::uint32_t> reached{room};
        std::vector<std::uint32_t> open{room};
        while (!open.empty()) {
            const std::uint32_t from = open.back();
            open.pop_back();
            for (auto next = passages.lower_bound({from, 0});
                 next != passages.end() && next->first == from; ++next)
                if (reached.insert(next->second).second) open.push_back(next->second);
        }
        return reached;
    }

    Rooms rooms() {
        const auto bit_of = bits();
        if (bit_of.size() < 2) return {};
        const Passages ways = passages(bit_of);
        std::map<std::uint32_t, std::uint32_t> reached;
        for (const auto& [room, bit] : bit_of)
            for (const std::uint32_t other : reached_from(room, ways))
                reached[room] |= bit_of.at(other);
        std::uint32_t all = 0;
        for (const auto& [room, bit] : bit_of) all |= bit;
        for (auto& [room, bits] : reached)
            if (bits == all) bits = kAllRooms;
        Rooms result;
        for (std::uint32_t patch = 0; patch < mesh_.patches.size(); ++patch) {
            const std::uint32_t room = room_at(front_of(patch));
            result.before.push_back(bit_of.at(room));
            result.reached.push_back(reached.at(room));
        }
        return result;
    }

    const Mesh& mesh_;
    MergedVertices vertices_;
    double play_;
    std::vector<std::uint32_t> shell_of_;  // [side]
    std::vector<Shell> shells_;
    std::vector<std::uint32_t> enclosing_, lit_;  // those that do, and of these those with fronts
    std::map<std::uint32_t, std::optional<Enclosure>> enclosures_;
    meshing::DisjointSets rooms_;  // of shells, and what is outside of all
    std::size_t looks_ = 0;
};

}  // namespace

Rooms find_rooms(const Mesh& mesh) {
    if (mesh.patches.size() > kMostPatches) return {};
    if (!(mesh.weld > 0)) return {};
    return RoomFinder(mesh).run();
}

}  // namespace hemirad
