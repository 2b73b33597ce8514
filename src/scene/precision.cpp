#include "scene/precision.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "errors.h"
#include "scene/bounds.h"
#include "scene/input_file.h"

namespace hemirad::meshing {
namespace {

/// Of the positions that faces use.
struct Reach {
    double largest = 0;    ///< |coordinate|
    double half_side = 0;  ///< half of the longest side of the bounding box
};

Reach reach_of(const Scene& scene) {
    const auto [low, high] = bounds_of(scene);
    if (!(low.x <= high.x)) return {};
    const glm::dvec3 largest = glm::max(glm::abs(low), glm::abs(high));
    const glm::dvec3 half = 0.5 * high - 0.5 * low;
    return {std::max({largest.x, largest.y, largest.z}), std::max({half.x, half.y, half.z})};
}

// Lengths of area vectors are fourth powers of lengths: at 1e70 m they overflow no double, and at
// 1e-70 m a face as narrow as the precision keeps its digits.
void check_reach(const Scene& scene, const Reach& reach) {
    constexpr double kLargest = 1e70, kSmallest = 1e-70;
    if (reach.largest > kLargest || (reach.largest > 0 && reach.half_side < kSmallest))
        throw InputError(scene.file + ": the largest coordinate is " + number(reach.largest) +
                         " m, out of range");
}

// Two roundings of one point differ by at most two quanta an axis, 2 sqrt(3) < 4 in space. A scene
// that does not say was written in floats: as one ulp of the largest coordinate, twice what they
// were rounded by, since points that others computed in floats err by more than their own rounding.
double weld_of_quantum(const Scene& scene, const Reach& reach) {
    const double quantum = scene.quantum > 0 ? scene.quantum : 0x1p-23 * reach.largest;
    return 4 * quantum;
}

// The device puts half of the longest side on a grid of 2^30 steps: its neighbours are one, and so
// are those two steps apart, where each may be rounded towards the other. A place in doubles is the
// sum of four products, at most 3.5 ulps of the largest coordinate off, two of them 7 apart.
double least_weld(const Reach& reach) {
    constexpr double kDoubleUlp = 0x1p-52;
    return std::max(0x1p-29 * reach.half_side, 8 * kDoubleUlp * reach.largest);
}

void check_weld(const Scene& scene, double weld, double least, const Reach& reach) {
    if (weld < least)
        throw InputError(scene.file + ": --weld " + number(weld) +
                         " m is less than coordinates are told apart by, " + number(least) + " m");
    if (weld > reach.half_side)
        throw InputError(scene.file + ": --weld " + number(weld) +
                         " m leaves nothing of a scene of " + number(2 * reach.half_side) + " m");
}

}  // namespace

Precision precision_of(const Scene& scene, double weld) {
    const Reach reach = reach_of(scene);
    check_reach(scene, reach);
    const double least = least_weld(reach);
    if (weld > 0)
        check_weld(scene, weld, least, reach);
    else
        weld = std::max(weld_of_quantum(scene, reach), least);
    return {weld, 2 * weld};
}

}  // namespace hemirad::meshing
