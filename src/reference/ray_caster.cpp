#include "reference/ray_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "reference/projector.h"

namespace hemirad::reference {
namespace {

using glm::dvec3;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kLeafPolygons = 4;
/// Of a box, relative to its distance: wider than what rounds in the slab test.
constexpr double kBoxPlay = 1e-12;

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

dvec3 middle_of(const Polygon& polygon) {
    const auto& c = polygon.corners;
    return (c[0] + c[1] + c[2] + c[3]) / 4.0;
}

}  // namespace

struct RayCaster::Hit {
    double distance = kInfinity;
    int polygon = kEscaped;
};

RayCaster::RayCaster(std::span<const Polygon> polygons)
    : polygons_(polygons.begin(), polygons.end()), order_(polygons.size()) {
    for (const Polygon& polygon : polygons_) {
        normals_.push_back(normal(polygon));
        least_heights_.push_back(least_height(polygon));
    }
    std::iota(order_.begin(), order_.end(), 0);
    if (!order_.empty()) build(0, std::uint32_t(order_.size()));
}

void RayCaster::build(std::uint32_t first, std::uint32_t count) {
    Node node{dvec3(kInfinity), dvec3(-kInfinity), first, count, 0};
    const auto begin = order_.begin() + first, end = begin + count;
    for (auto it = begin; it != end; ++it)
        for (const dvec3& corner : polygons_[std::size_t(*it)].corners) {
            node.least = glm::min(node.least, corner);
            node.most = glm::max(node.most, corner);
        }
    const std::size_t at = nodes_.size();
    nodes_.push_back(node);
    if (count <= kLeafPolygons) return;
    const dvec3 extent = node.most - node.least;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const auto key = [&](int polygon) { return middle_of(polygons_[std::size_t(polygon)])[axis]; };
    std::nth_element(begin, begin + count / 2, end, [&](int a, int b) { return key(a) < key(b); });
    nodes_[at].count = 0;
    build(first, count / 2);
    nodes_[at].second_child = std::uint32_t(nodes_.size());
    build(first + count / 2, count - count / 2);
}

// The signs of the edges' moments, as projector.cpp argues them; equal distance: lowest index.
void RayCaster::meet(int polygon, const dvec3& origin, const dvec3& direction, Hit& hit) const {
    const auto& corners = polygons_[std::size_t(polygon)].corners;
    const dvec3& normal = normals_[std::size_t(polygon)];
    const double cosine = -glm::dot(normal, direction);
    const double height = glm::dot(normal, origin - corners[0]);
    if (cosine <= 0 || height <= least_heights_[std::size_t(polygon)]) return;
    const double distance = height / cosine;
    if (distance > hit.distance || (distance == hit.distance && polygon > hit.polygon)) return;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const dvec3 p = corners[k] - origin;
        const dvec3 q = corners[(k + 1) % corners.size()] - origin;
        if (glm::dot(glm::cross(q, p), direction) < 0) return;
    }
    hit = {distance, polygon};
}

int RayCaster::operator()(const dvec3& origin, const dvec3& direction) const {
    Hit hit;
    const dvec3 inverse = 1.0 / direction;
    std::vector<std::uint32_t> ahead;
    if (!nodes_.empty()) ahead.push_back(0);
    while (!ahead.empty()) {
        const std::uint32_t at = ahead.back();
        ahead.pop_back();
        const Node& node = nodes_[at];
        if (!may_meet(node.least, node.most, origin, inverse, hit.distance)) continue;
        for (std::uint32_t i = 0; i < node.count; ++i)
            meet(order_[node.first + i], origin, direction, hit);
        if (node.count > 0) continue;
        ahead.push_back(node.second_child);
        ahead.push_back(at + 1);
    }
    return hit.polygon;
}

}  // namespace hemirad::reference
