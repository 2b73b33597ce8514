#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "scene/frame.h"
#include "scene/polygon.h"
#include "scene/vertex_welder.h"

namespace hemirad::meshing {

/// The line dot(across, at) = offset in a surface's plane; `across` has length 1.
struct Line {
    glm::dvec2 across;
    double offset;

    double along_normal(const Corner& c) const { return glm::dot(across, c.at); }
};

/// On either side of a line; empty where nothing reaches there.
template <class Outline>
struct Halves {
    Outline below, above;
};

/// Sutherland and Hodgman (1974), both sides at once. A corner within `slack` of the line counts as
/// on it and stays where it is, so nothing is moved and no sliver arises beside a line. `cross`
/// gives the corner where the edge from one corner to another meets the line.
template <class Outline, class Cross>
Halves<Outline> split(const Outline& outline, const Line& line, double slack, Cross cross) {
    const auto side = [&](const Corner& c) {
        const double beyond = line.along_normal(c) - line.offset;
        return beyond > slack ? 1 : beyond < -slack ? -1 : 0;
    };
    Halves<Outline> halves;
    bool reaches_below = false, reaches_above = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const auto& a = outline[i];
        const auto& b = outline[(i + 1) % outline.size()];
        const int side_a = side(a);
        if (side_a <= 0) halves.below.push_back(a);
        if (side_a >= 0) halves.above.push_back(a);
        if (side_a < 0) reaches_below = true;
        if (side_a > 0) reaches_above = true;
        if (side_a * side(b) >= 0) continue;
        const double from_a = line.along_normal(a);
        const double fraction = (line.offset - from_a) / (line.along_normal(b) - from_a);
        const auto crossing = cross(a, b, fraction);
        halves.below.push_back(crossing);
        halves.above.push_back(crossing);
    }
    if (!reaches_below) halves.below.clear();
    if (!reaches_above) halves.above.clear();
    return halves;
}

/// Once each of the vertices that follow one another; nothing where fewer than three are left.
void remove_repeats(Polygon& polygon);

/// Cuts polygons of one plane in two. New vertices go to the welder, but are not drawn to what is
/// near: they stay on the edge that they divide, to which neighbours that are not cut have no
/// vertex. Both polygons of an edge that crosses a line get the same vertex there: the second one's
/// differs by rounding only.
class PolygonSplitter {
  public:
    PolygonSplitter(const Frame& frame, VertexWelder& vertices)
        : frame_(frame), vertices_(vertices) {}

    Halves<Polygon> split(const Polygon& polygon, const Line& line, double slack);

  private:
    Corner cross(const Corner& a, const Corner& b, double fraction);

    Frame frame_;
    VertexWelder& vertices_;
};

}  // namespace hemirad::meshing
