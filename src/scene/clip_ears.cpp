#include "scene/clip_ears.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>

#include "scene/reflex_tree.h"

namespace hemirad::meshing {
namespace {

/// Knows of each corner what blocks it, so that it is looked at again only once its neighbours
/// change or what blocks it no longer does.
class EarClipper {
  public:
    EarClipper(const Polygon& polygon, double precision)
        : polygon_(polygon),
          precision_(precision),
          tree_(polygon),
          before_(polygon.size()),
          behind_(polygon.size()),
          is_gone_(polygon.size()),
          blocked_by_(polygon.size()) {
        const auto n = static_cast<std::uint32_t>(polygon.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            before_[i] = (i + n - 1) % n;
            behind_[i] = (i + 1) % n;
        }
        for (std::uint32_t i = 0; i < n; ++i) look_again(i);
    }

    std::vector<std::array<Corner, 3>> run() {
        std::vector<std::array<Corner, 3>> triangles;
        for (std::size_t left = polygon_.size(); left > 2; --left)
            if (const auto ear = find_ear()) {
                triangles.push_back(triangle(*ear));
                remove(*ear);
            } else if (!straight_.empty()) {
                remove(*straight_.begin());
            } else {
                return {};
            }
        return triangles;
    }

    std::size_t looks() const { return tree_.looks(); }

  private:
    std::array<Corner, 3> triangle(std::uint32_t i) const {
        return {polygon_[before_[i]], polygon_[i], polygon_[behind_[i]]};
    }

    std::optional<std::uint32_t> find_ear() {
        while (!open_.empty()) {
            const std::uint32_t i = *open_.begin();
            const auto blocking = tree_.find_in(triangle(i));
            if (!blocking) return i;
            blocked_by_[*blocking].push_back(i);
            open_.erase(i);
        }
        return {};
    }

    void remove(std::uint32_t i) {
        is_gone_[i] = true;
        open_.erase(i);
        straight_.erase(i);
        set_reflex(i, false);
        behind_[before_[i]] = behind_[i];
        before_[behind_[i]] = before_[i];
        look_again(before_[i]);
        look_again(behind_[i]);
    }

    void look_again(std::uint32_t i) {
        const auto [a, b, c] = triangle(i);
        set_reflex(i, turn(a, b, c) <= 0);
        put(i, std::abs(bulge(a, b, c)) <= precision_, straight_);
        put(i, has_area(i), open_);
    }

    bool has_area(std::uint32_t i) const {
        const auto [a, b, c] = triangle(i);
        return turn(a, b, c) > 0 && thickness({a, b, c}) > precision_;
    }

    // Only a corner that does not turn left can be the one that blocks an ear.
    void set_reflex(std::uint32_t i, bool reflex) {
        tree_.set_reflex(i, reflex);
        if (reflex) return;
        for (const std::uint32_t blocked : std::exchange(blocked_by_[i], {}))
            if (!is_gone_[blocked] && has_area(blocked)) open_.insert(blocked);
    }

    static void put(std::uint32_t i, bool is_one, std::set<std::uint32_t>& corners) {
        if (is_one)
            corners.insert(i);
        else
            corners.erase(i);
    }

    const Polygon& polygon_;
    double precision_;
    ReflexTree tree_;
    std::vector<std::uint32_t> before_, behind_;
    std::vector<bool> is_gone_;
    std::vector<std::vector<std::uint32_t>> blocked_by_;
    std::set<std::uint32_t> open_;  ///< those with an area of which nothing is known to block them
    std::set<std::uint32_t> straight_;
};

}  // namespace

std::vector<std::array<Corner, 3>> clip_ears(const Polygon& polygon, double precision,
                                             std::size_t* looks) {
    EarClipper clipper(polygon, precision);
    auto triangles = clipper.run();
    if (looks) *looks += clipper.looks();
    return triangles;
}

}  // namespace hemirad::meshing
