#include "scene/point_tree.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace hemirad::meshing {
namespace {

constexpr std::size_t kLeaf = 8;

struct Segment {
    glm::dvec3 from, along;
    double distance;

    bool is_near(const glm::dvec3& p) const {
        const double square = glm::dot(along, along);
        const double t = glm::dot(p - from, along) / square;
        const glm::dvec3 apart = p - from - t * along;
        return t > 0 && t < 1 && glm::dot(apart, apart) <= distance * distance;
    }
};

/// A stretch of a segment, and a range of points to look for beside it.
struct Visit {
    std::size_t begin, end;
    double t0, t1;
};

// What of the stretch lies where sign * (coordinate - split) <= distance; empty: t0 > t1.
Visit clipped(Visit visit, const Segment& segment, int axis, double split, double sign) {
    const double slope = sign * segment.along[axis];
    const double room = segment.distance - sign * (segment.from[axis] - split);
    if (slope > 0) visit.t1 = std::min(visit.t1, room / slope);
    if (slope < 0) visit.t0 = std::max(visit.t0, room / slope);
    if (slope == 0 && room < 0) visit.t1 = -std::numeric_limits<double>::infinity();
    return visit;
}

}  // namespace

PointTree::PointTree(const std::vector<glm::dvec3>& positions, std::vector<std::uint32_t> points)
    : positions_(positions), points_(std::move(points)), axes_(points_.size()) {
    build(0, points_.size());
}

void PointTree::build(std::size_t begin, std::size_t end) {
    if (end - begin <= kLeaf) return;
    glm::dvec3 low = positions_[points_[begin]], high = low;
    for (std::size_t i = begin; i < end; ++i) {
        low = glm::min(low, positions_[points_[i]]);
        high = glm::max(high, positions_[points_[i]]);
    }
    const glm::dvec3 side = high - low;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const std::size_t middle = (begin + end) / 2;
    const auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        return positions_[a][axis] < positions_[b][axis];
    });
    axes_[middle] = static_cast<std::uint8_t>(axis);
    build(begin, middle);
    build(middle + 1, end);
}

std::vector<std::uint32_t> PointTree::near(const glm::dvec3& from, const glm::dvec3& to,
                                           double distance) const {
    // Twice the distance where the tree is pruned: its comparisons round, too.
    const Segment segment{from, to - from, distance}, wide{from, to - from, 2 * distance};
    std::vector<std::uint32_t> found;
    std::vector<Visit> open{{0, points_.size(), 0, 1}};
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        if (visit.end - visit.begin <= kLeaf) {
            for (std::size_t i = visit.begin; i < visit.end; ++i)
                if (segment.is_near(positions_[points_[i]])) found.push_back(points_[i]);
            continue;
        }
        const std::size_t middle = (visit.begin + visit.end) / 2;
        const int axis = axes_[middle];
        const glm::dvec3& at = positions_[points_[middle]];
        if (segment.is_near(at)) found.push_back(points_[middle]);
        const double split = at[axis];
        for (const Visit& half :
             {clipped({visit.begin, middle, visit.t0, visit.t1}, wide, axis, split, 1),
              clipped({middle + 1, visit.end, visit.t0, visit.t1}, wide, axis, split, -1)})
            if (half.t0 <= half.t1) open.push_back(half);
    }
    return found;
}

}  // namespace hemirad::meshing
