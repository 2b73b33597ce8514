#include "lightmap/texel_areas.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace hemirad {
namespace {

/// Sutherland and Hodgman (1974): the part where the distance of a point is not negative.
template <class Distance>
TexelPolygon clip(const TexelPolygon& polygon, Distance distance) {
    TexelPolygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& from = polygon.corners[i];
        const glm::dvec2& to = polygon.corners[(i + 1) % polygon.count];
        const double from_distance = distance(from), to_distance = distance(to);
        if (from_distance >= 0.0) kept.add(from);
        if (from_distance * to_distance < 0.0)
            kept.add(from + (to - from) * (from_distance / (from_distance - to_distance)));
    }
    return kept;
}

TexelPolygon clip_to_slab(const TexelPolygon& polygon, int axis, double low) {
    return clip(clip(polygon, [&](const glm::dvec2& p) { return p[axis] - low; }),
                [&](const glm::dvec2& p) { return low + 1.0 - p[axis]; });
}

struct Span {
    std::uint32_t first, last;  ///< texels first ... last - 1
};

Span texels_of(const TexelPolygon& polygon, int axis, std::uint32_t start, std::uint32_t size) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const glm::dvec2& corner : polygon.used()) {
        low = std::min(low, corner[axis]);
        high = std::max(high, corner[axis]);
    }
    const double from = start, to = from + size;
    return {static_cast<std::uint32_t>(std::clamp(std::floor(low), from, to)),
            static_cast<std::uint32_t>(std::clamp(std::ceil(high), from, to))};
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - b.x * a.y; }

}  // namespace

void TexelPolygon::add(const glm::dvec2& corner) {
    assert(count < corners.size());
    corners[count++] = corner;
}

double area_of(const TexelPolygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.count; ++i)
        twice += cross(polygon.corners[i] - polygon.corners[0],
                       polygon.corners[(i + 1) % polygon.count] - polygon.corners[0]);
    return std::abs(twice) / 2.0;
}

bool holds(const TexelPolygon& polygon, const glm::dvec2& point) {
    bool left = false, right = false;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& from = polygon.corners[i];
        const double turn = cross(polygon.corners[(i + 1) % polygon.count] - from, point - from);
        left = left || turn > 0;
        right = right || turn < 0;
    }
    return !(left && right);
}

TexelPolygon clip_to_triangle(TexelPolygon polygon, const std::array<glm::dvec2, 3>& triangle) {
    const double turn = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]) < 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec2 &from = triangle[i], along = triangle[(i + 1) % 3] - from;
        polygon = clip(polygon, [&](const glm::dvec2& p) { return turn * cross(along, p - from); });
    }
    return polygon;
}

void find_texel_areas(const TexelPolygon& polygon, const Rectangle& within,
                      std::vector<TexelArea>& found) {
    found.clear();
    const Span rows = texels_of(polygon, 1, within.y, within.height);
    for (std::uint32_t y = rows.first; y < rows.last; ++y) {
        const TexelPolygon strip = clip_to_slab(polygon, 1, y);
        if (strip.count < 3) continue;
        const Span columns = texels_of(strip, 0, within.x, within.width);
        for (std::uint32_t x = columns.first; x < columns.last; ++x)
            found.push_back({x, y, area_of(clip_to_slab(strip, 0, x))});
    }
}

}  // namespace hemirad
