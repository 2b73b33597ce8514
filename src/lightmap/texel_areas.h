#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "lightmap/pack_rectangles.h"

namespace hemirad {

/// A convex polygon, in an atlas in texels. A quad that a triangle and four edges cut has at most
/// eleven corners; more is room for one that rounding has left slightly concave.
struct TexelPolygon {
    std::array<glm::dvec2, 20> corners{};
    std::size_t count = 0;

    void add(const glm::dvec2& corner);
    std::span<const glm::dvec2> used() const { return {corners.data(), count}; }
};

double area_of(const TexelPolygon& polygon);

bool holds(const TexelPolygon& polygon, const glm::dvec2& point);

/// The part of the polygon that lies in a triangle, whichever way round that goes.
TexelPolygon clip_to_triangle(TexelPolygon polygon, const std::array<glm::dvec2, 3>& triangle);

/// How much of a texel a polygon fills.
struct TexelArea {
    std::uint32_t x, y;
    double area;
};

/// Those of the rectangle's texels that the polygon reaches into, row by row.
void find_texel_areas(const TexelPolygon& polygon, const Rectangle& within,
                      std::vector<TexelArea>& found);

}  // namespace hemirad
