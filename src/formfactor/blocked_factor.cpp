#include "formfactor/blocked_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "formfactor/convex.h"
#include "formfactor/visible_pieces.h"

namespace hemirad {
namespace {

using formfactor::Plane;

constexpr double kCoplanar = 1e-12;  // relative to the extent of a pair
constexpr double kClosedFormError = 1e-9;
// Calibrated on random triples (tests/formfactor/blocked_factor_test.cpp). The error of a cell is
// of the size of the step from one point to four. But shadows may pass between the points: they are
// as sharp as a blocker is near, so what may be unseen is a share of the cell that falls with the
// cell's size over the distance of the nearest blocker.
constexpr double kSafety = 1.5;
constexpr double kUnseen = 0.1;
constexpr std::size_t kBarsOfAGrille = 48;

struct Blocker {
    ConvexPolygon corners;
    Plane plane;

    bool holds(const glm::dvec3& point) const {
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const glm::dvec3 edge = corners[(k + 1) % corners.size()] - corners[k];
            if (glm::dot(glm::cross(plane.normal, edge), point - corners[k]) < 0) return false;
        }
        return true;
    }

    double distance(const glm::dvec3& point) const {
        if (holds(point)) return std::abs(plane.height(point));
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const glm::dvec3 edge = corners[(k + 1) % corners.size()] - corners[k];
            const glm::dvec3 gap = point - corners[k];
            const double along = std::clamp(glm::dot(gap, edge) / glm::dot(edge, edge), 0.0, 1.0);
            least = std::min(least, glm::distance(gap, along * edge));
        }
        return least;
    }
};

struct Pair {
    ConvexPolygon from, to;  // the parts in front of each other
    Plane from_plane, to_plane;
    double margin;
};

bool any_above(const Plane& plane, std::span<const glm::dvec3> polygon, double margin) {
    return std::ranges::any_of(
        polygon, [&](const glm::dvec3& corner) { return plane.height(corner) > margin; });
}

bool none_above(const Plane& plane, std::span<const glm::dvec3> polygon, double margin) {
    return !any_above(plane, polygon, margin);
}

Plane reversed(const Plane& plane) { return {-plane.normal, -plane.offset}; }

using Corners = std::span<const glm::dvec3>;

// Planes with all of two polygons on their back, each through an edge of the first and a corner of
// the second: the shaft's sides (Haines and Wallace 1991).
void add_shaft_planes(Corners a, Corners b, double margin, std::vector<Plane>& planes) {
    for (std::size_t k = 0; k < a.size(); ++k)
        for (const glm::dvec3& corner : b) {
            const std::array<glm::dvec3, 3> side = {a[k], a[(k + 1) % a.size()], corner};
            Plane plane = formfactor::plane_of(side);
            if (plane.normal == glm::dvec3(0)) continue;
            if (any_above(plane, a, margin) || any_above(plane, b, margin)) plane = reversed(plane);
            if (none_above(plane, a, margin) && none_above(plane, b, margin))
                planes.push_back(plane);
        }
}

enum class Effect { none, partial, total };

// What lies between a part of `from` and all of `to`.
class Shaft {
  public:
    void set(const Pair& pair, Corners part) {
        pair_ = &pair;
        part_ = part;
        planes_.clear();
    }

    Effect effect(const Blocker& blocker) {
        const double margin = pair_->margin;
        if (!any_above(blocker.plane, part_, margin) ||
            !any_above(reversed(blocker.plane), pair_->to, margin))
            return Effect::none;
        if (planes_.empty()) add_planes();
        for (const Plane& plane : planes_)
            if (none_above(reversed(plane), blocker.corners, margin)) return Effect::none;
        return hides_all(blocker) ? Effect::total : Effect::partial;
    }

  private:
    void add_planes() {
        planes_ = {reversed(pair_->from_plane), reversed(pair_->to_plane)};
        add_shaft_planes(part_, pair_->to, pair_->margin, planes_);
        add_shaft_planes(pair_->to, part_, pair_->margin, planes_);
    }

    // The lines between all points of two convex polygons cross a plane between them within the
    // convex hull of where the lines between their corners do.
    bool hides_all(const Blocker& blocker) const {
        for (const glm::dvec3& eye : part_)
            for (const glm::dvec3& seen : pair_->to) {
                const double near = blocker.plane.height(eye), far = blocker.plane.height(seen);
                if (near <= pair_->margin || far >= -pair_->margin) return false;
                if (!blocker.holds(eye + near / (near - far) * (seen - eye))) return false;
            }
        return true;
    }

    const Pair* pair_ = nullptr;
    Corners part_;
    std::vector<Plane> planes_;
};

// The plane through the eye and an edge of no length is nothing but rounding.
ConvexPolygon without_repeats(const ConvexPolygon& polygon, double margin) {
    ConvexPolygon kept;
    for (std::size_t k = 0; k < polygon.size(); ++k)
        if (glm::distance(polygon[k], polygon[(k + 1) % polygon.size()]) > margin)
            kept.push_back(polygon[k]);
    return kept;
}

struct Blockers {
    std::vector<Blocker> partial;
    bool total = false;
};

Blockers blockers_between(const Pair& pair, std::span<const ConvexPolygon> candidates) {
    Blockers blockers;
    Shaft shaft;
    shaft.set(pair, pair.from);
    Blocker blocker;
    for (const ConvexPolygon& candidate : candidates) {
        blocker.corners = candidate;
        blocker.plane = formfactor::plane_of(candidate);
        if (blocker.plane.normal == glm::dvec3(0)) continue;
        Effect effect = shaft.effect(blocker);
        if (effect == Effect::none) continue;
        if (any_above(reversed(pair.to_plane), candidate, 0)) {
            blocker.corners = formfactor::in_front(pair.to_plane, candidate, pair.margin);
            effect = shaft.effect(blocker);
        }
        blocker.corners = without_repeats(blocker.corners, pair.margin);
        blockers.total |= effect == Effect::total;
        if (effect == Effect::partial) blockers.partial.push_back(blocker);
    }
    return blockers;
}

// From one or more points: Lambert's factor of what is visible, and of all.
struct Sight {
    double visible = 0, whole = 0;

    Sight operator+(const Sight& other) const {
        return {visible + other.visible, whole + other.whole};
    }
    Sight operator-(const Sight& other) const {
        return {visible - other.visible, whole - other.whole};
    }
    Sight operator*(double factor) const { return {visible * factor, whole * factor}; }
};

using Triangle = std::array<glm::dvec3, 3>;

glm::dvec3 centroid(const Triangle& t) { return (t[0] + t[1] + t[2]) / 3.0; }

// The middle one first, which shares the centroid.
std::array<Triangle, 4> parts_of(const Triangle& t) {
    const glm::dvec3 ab = 0.5 * (t[0] + t[1]), bc = 0.5 * (t[1] + t[2]), ca = 0.5 * (t[2] + t[0]);
    return {Triangle{ab, bc, ca}, {t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}};
}

// Blockers that may matter to a cell, in one list of those of all cells.
struct Range {
    std::size_t begin, end;
    bool hidden = false;  // all of `to`, by one blocker
};

// A triangle of `from`, seen from the centroids of its four parts.
struct Cell {
    Triangle corners;
    double area;
    Range blockers;
    std::array<Sight, 4> sights;
    Sight step;           // of the integral, from one point to four
    double unseen = 0;    // what may pass between the points
    double residual = 0;  // of the step, when the cell was made

    Sight integral() const {
        return (sights[0] + sights[1] + sights[2] + sights[3]) * (0.25 * area);
    }
};

// The share of `to` that is visible, weighed by the kernel. Dividing by the sum of the kernel over
// the same points leaves only the variation of visibility as an error (ratio estimator: Cochran
// 1977).
class VisibleShare {
  public:
    VisibleShare(Pair pair, std::vector<Blocker> blockers, double target, int most_points)
        : pair_(std::move(pair)), blockers_(std::move(blockers)) {
        for (std::size_t index = 0; index < blockers_.size(); ++index) lists_.push_back(index);
        for (const Triangle& triangle : triangles())
            add_cell(triangle, narrowed(triangle, {0, blockers_.size()}), {});
        std::size_t next_sort = 16;
        while (error() > target && points_ + 13 <= most_points) {
            if (cells_.size() >= next_sort) {
                sort_anew();
                next_sort *= 2;
            }
            split_largest();
        }
    }

    double value() const { return sum_.whole > 0 ? sum_.visible / sum_.whole : 0; }

    // Of value(), 1 at most.
    double error() const {
        if (sum_.whole <= 0) return 0;
        const double v = value();
        const double squares = steps_vv_ - 2 * v * steps_vw_ + v * v * steps_ww_ + unseen_;
        return std::min(1.0, kSafety * std::sqrt(std::max(0.0, squares)) / sum_.whole);
    }

  private:
    // Halved cells have points in step with a grille of many bars, and might all look through it,
    // or none. About a point at irrational shares of the diagonals they do not.
    std::vector<Triangle> triangles() const {
        const ConvexPolygon& from = pair_.from;
        std::vector<Triangle> result;
        if (blockers_.size() < kBarsOfAGrille) {
            for (std::size_t k = 1; k + 1 < from.size(); ++k)
                result.push_back({from[0], from[k], from[k + 1]});
            return result;
        }
        const glm::dvec3 middle = from[0] + 0.7548776662466927 * (from[1] - from[0]);
        const glm::dvec3 apex = middle + 0.5698402909980532 * (from[from.size() - 1] - middle);
        for (std::size_t k = 0; k < from.size(); ++k)
            result.push_back({apex, from[k], from[(k + 1) % from.size()]});
        return result;
    }

    Range narrowed(const Triangle& triangle, const Range& from) {
        if (from.hidden) return from;
        Range range{lists_.size(), lists_.size()};
        shaft_.set(pair_, triangle);
        for (std::size_t at = from.begin; at < from.end; ++at) {
            const Effect effect = shaft_.effect(blockers_[lists_[at]]);
            if (effect == Effect::partial) lists_.push_back(lists_[at]);
            range.hidden |= effect == Effect::total;
        }
        range.end = lists_.size();
        return range;
    }

    Sight sight(const glm::dvec3& eye, const Range& blockers) {
        ++points_;
        pieces_.begin(pair_.to, eye);
        const double whole = pieces_.factor(pair_.from_plane.normal);
        if (blockers.hidden) return {0, whole};
        bool taken = false;
        for (std::size_t at = blockers.begin; at < blockers.end && !pieces_.empty(); ++at) {
            const Blocker& blocker = blockers_[lists_[at]];
            if (blocker.plane.height(eye) > pair_.margin)
                taken |= pieces_.hide_behind(blocker.corners);
        }
        return {taken ? std::min(whole, pieces_.factor(pair_.from_plane.normal)) : whole, whole};
    }

    double unseen_share(const Triangle& t, const Range& blockers) const {
        if (blockers.hidden || blockers.begin == blockers.end) return 0;
        const glm::dvec3 centre = centroid(t);
        double radius = 0, nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& corner : t) radius = std::max(radius, glm::distance(corner, centre));
        for (std::size_t at = blockers.begin; at < blockers.end; ++at)
            nearest = std::min(nearest, blockers_[lists_[at]].distance(centre));
        const double sharpness = std::min(1.0, radius / std::max(nearest, radius));
        return kUnseen * sharpness;
    }

    double residual(const Cell& cell) const {
        return std::hypot(cell.step.visible - value() * cell.step.whole, cell.unseen);
    }

    // value() has moved since the residuals were found.
    void sort_anew() {
        for (Cell& cell : cells_) cell.residual = residual(cell);
        std::ranges::make_heap(cells_, {}, &Cell::residual);
    }

    void add_cell(const Triangle& t, const Range& blockers, std::optional<Sight> centre) {
        const auto parts = parts_of(t);
        Cell cell{t, 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0])), blockers, {}, {}};
        for (std::size_t k = 0; k < 4; ++k)
            cell.sights[k] = k == 0 && centre ? *centre : sight(centroid(parts[k]), blockers);
        cell.step = cell.integral() - cell.sights[0] * cell.area;
        cell.unseen = unseen_share(t, blockers) * cell.integral().whole;
        account(cell, 1);
        cell.residual = residual(cell);
        cells_.push_back(cell);
        std::ranges::push_heap(cells_, {}, &Cell::residual);
    }

    void account(const Cell& cell, double sign) {
        sum_ = sum_ + cell.integral() * sign;
        steps_vv_ += sign * cell.step.visible * cell.step.visible;
        steps_vw_ += sign * cell.step.visible * cell.step.whole;
        steps_ww_ += sign * cell.step.whole * cell.step.whole;
        unseen_ += sign * cell.unseen * cell.unseen;
    }

    void split_largest() {
        std::ranges::pop_heap(cells_, {}, &Cell::residual);
        const Cell cell = cells_.back();
        cells_.pop_back();
        account(cell, -1);
        const auto parts = parts_of(cell.corners);
        for (std::size_t k = 0; k < 4; ++k)
            add_cell(parts[k], narrowed(parts[k], cell.blockers), cell.sights[k]);
    }

    const Pair pair_;
    const std::vector<Blocker> blockers_;
    int points_ = 0;
    Shaft shaft_;
    formfactor::VisiblePieces pieces_;
    std::vector<std::size_t> lists_;
    std::vector<Cell> cells_;  // a heap, the largest residual first
    Sight sum_;
    // Sums of products of steps, and of squares of what is unseen.
    double steps_vv_ = 0, steps_vw_ = 0, steps_ww_ = 0, unseen_ = 0;
};

Pair pair_of(std::span<const glm::dvec3> from, std::span<const glm::dvec3> to) {
    Pair pair;
    pair.from_plane = formfactor::plane_of(from);
    pair.to_plane = formfactor::plane_of(to);
    pair.margin = kCoplanar *
                  (formfactor::reach(from) + formfactor::reach(to) + glm::distance(from[0], to[0]));
    pair.from = formfactor::in_front(pair.to_plane, from, pair.margin);
    pair.to = formfactor::in_front(pair.from_plane, to, pair.margin);
    return pair;
}

// Shadows on a polygon are as sharp as it is large and its blockers are near.
double sharpness(const ConvexPolygon& polygon, const std::vector<Blocker>& blockers) {
    const double size = formfactor::reach(polygon);
    double sum = 0;
    for (const Blocker& blocker : blockers) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& corner : polygon)
            nearest = std::min(nearest, blocker.distance(corner));
        sum += size / (nearest + 0.1 * size);
    }
    return sum;
}

// What hides `to` from `from` hides it by its back the other way.
Pair turned(const Pair& pair) {
    return {pair.to, pair.from, pair.to_plane, pair.from_plane, pair.margin};
}

std::vector<Blocker> turned(const std::vector<Blocker>& blockers, const Pair& pair) {
    std::vector<Blocker> backs;
    for (const Blocker& blocker : blockers) {
        const auto nearer = formfactor::in_front(pair.from_plane, blocker.corners, pair.margin);
        Blocker back{without_repeats(nearer, pair.margin), reversed(blocker.plane)};
        std::ranges::reverse(back.corners);
        if (back.corners.size() >= 3) backs.push_back(back);
    }
    return backs;
}

}  // namespace

Estimate blocked_polygon_to_polygon(std::span<const glm::dvec3> from,
                                    std::span<const glm::dvec3> to,
                                    std::span<const ConvexPolygon> blockers, double target_error,
                                    int most_points) {
    return blocked_polygon_to_polygon(from, to, polygon_to_polygon(from, to), blockers,
                                      target_error, most_points);
}

Estimate blocked_polygon_to_polygon(std::span<const glm::dvec3> from,
                                    std::span<const glm::dvec3> to, double whole,
                                    std::span<const ConvexPolygon> blockers, double target_error,
                                    int most_points) {
    if (whole <= 0) return {0, kClosedFormError};
    const Pair pair = pair_of(from, to);
    const auto between = blockers_between(pair, blockers);
    if (between.total) return {0, kClosedFormError};
    if (between.partial.empty()) return {whole, kClosedFormError};
    const bool backwards =
        sharpness(pair.to, between.partial) < sharpness(pair.from, between.partial);
    const VisibleShare share(backwards ? turned(pair) : pair,
                             backwards ? turned(between.partial, pair) : between.partial,
                             target_error / whole, most_points);
    return {whole * share.value(), whole * share.error() + kClosedFormError};
}

}  // namespace hemirad
