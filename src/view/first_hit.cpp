#include "view/first_hit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace hemirad {
namespace {

using glm::dvec3;

constexpr std::uint32_t kLeafFaces = 4;
/// Of a box, relative to its distance: wider than what rounds in the slab test.
constexpr double kBoxPlay = 1e-12;

// Of its twin in src/reference nothing is shared: that one is an oracle.
// A ray within the face of a slab gives 0 * inf: no limit of that axis.
bool may_meet(const dvec3& least, const dvec3& most, const dvec3& origin, const dvec3& inverse,
              double before) {
    double enter = 0, leave = before;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (least[axis] - origin[axis]) * inverse[axis];
        const double b = (most[axis] - origin[axis]) * inverse[axis];
        if (std::isnan(a) || std::isnan(b)) continue;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1 + kBoxPlay);
}

}  // namespace

FirstHit::FirstHit(const Scene& scene) : scene_(scene), order_(scene.faces.size()) {
    assert(std::ranges::all_of(scene.faces, [](const Face& f) { return f.vertices.size() == 3; }));
    std::iota(order_.begin(), order_.end(), 0);
    if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

Bounds FirstHit::box_of(std::uint32_t face) const {
    Bounds box;
    for (const std::uint32_t v : scene_.faces[face].vertices) box.take_in(scene_.positions[v]);
    return box;
}

void FirstHit::build(std::uint32_t first, std::uint32_t count) {
    const auto begin = order_.begin() + first, end = begin + count;
    Bounds box;
    for (auto face = begin; face != end; ++face) box.take_in(box_of(*face));
    const std::size_t at = nodes_.size();
    nodes_.push_back({box, first, count, 0});
    if (count <= kLeafFaces) return;
    const dvec3 extent = box.most - box.least;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    std::nth_element(begin, begin + count / 2, end, [&](std::uint32_t a, std::uint32_t b) {
        return box_of(a).middle()[axis] < box_of(b).middle()[axis];
    });
    nodes_[at].count = 0;
    build(first, count / 2);
    nodes_[at].second_child = static_cast<std::uint32_t>(nodes_.size());
    build(first + count / 2, count - count / 2);
}

// By the volumes that the ray spans with the edges: their signs say whether it passes inside, and
// neighbours find the same number with opposite sign for the edge they share. Weights are the
// volumes' ratios, which perspective does not bend. Of equal distances the first face's.
void FirstHit::meet(std::uint32_t face, const dvec3& origin, const dvec3& direction,
                    std::optional<Hit>& nearest) const {
    const auto& v = scene_.faces[face].vertices;
    const std::array corners{scene_.positions[v[0]] - origin, scene_.positions[v[1]] - origin,
                             scene_.positions[v[2]] - origin};
    dvec3 volumes;
    for (int i = 0; i < 3; ++i) {
        const dvec3& next = corners[std::size_t(i + 1) % 3];
        const dvec3& after = corners[std::size_t(i + 2) % 3];
        volumes[i] = glm::dot(glm::cross(after, next), direction);
        if (volumes[i] < 0) return;
    }
    const double sum = volumes.x + volumes.y + volumes.z;
    if (!(sum > 0)) return;
    const dvec3 weights = volumes / sum;
    const dvec3 at = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
    const double distance = glm::dot(at, direction) / glm::dot(direction, direction);
    if (!(distance > 0)) return;
    if (nearest &&
        (distance > nearest->distance || (distance == nearest->distance && face > nearest->face)))
        return;
    nearest = Hit{face, weights, distance};
}

std::optional<FirstHit::Hit> FirstHit::operator()(const dvec3& origin,
                                                  const dvec3& direction) const {
    std::optional<Hit> nearest;
    const dvec3 inverse = 1.0 / direction;
    std::vector<std::uint32_t> ahead;
    if (!nodes_.empty()) ahead.push_back(0);
    while (!ahead.empty()) {
        const std::uint32_t at = ahead.back();
        ahead.pop_back();
        const Node& node = nodes_[at];
        const double before = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
        if (!may_meet(node.box.least, node.box.most, origin, inverse, before)) continue;
        for (std::uint32_t i = 0; i < node.count; ++i)
            meet(order_[node.first + i], origin, direction, nearest);
        if (node.count > 0) continue;
        ahead.push_back(node.second_child);
        ahead.push_back(at + 1);
    }
    return nearest;
}

}  // namespace hemirad
