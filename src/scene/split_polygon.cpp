#include "scene/split_polygon.h"

#include <algorithm>

namespace hemirad::meshing {
namespace {

void remove_repeats(Polygon& polygon) {
    const auto repeated = std::ranges::unique(polygon, {}, &Corner::vertex);
    polygon.erase(repeated.begin(), repeated.end());
    while (polygon.size() > 1 && polygon.front().vertex == polygon.back().vertex)
        polygon.pop_back();
    if (polygon.size() < 3) polygon.clear();
}

int side(const Corner& c, const Line& line, double slack) {
    const double beyond = line.along_normal(c) - line.offset;
    return beyond > slack ? 1 : beyond < -slack ? -1 : 0;
}

}  // namespace

// Sutherland and Hodgman (1974), both sides at once.
Halves PolygonSplitter::split(const Polygon& polygon, const Line& line, double slack) {
    Halves halves;
    bool reaches_below = false, reaches_above = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[(i + 1) % polygon.size()];
        const int side_a = side(a, line, slack);
        if (side_a <= 0) halves.below.push_back(a);
        if (side_a >= 0) halves.above.push_back(a);
        if (side_a < 0) reaches_below = true;
        if (side_a > 0) reaches_above = true;
        if (side_a * side(b, line, slack) >= 0) continue;
        const Corner crossing = cross(a, b, line);
        halves.below.push_back(crossing);
        halves.above.push_back(crossing);
    }
    if (!reaches_below) halves.below.clear();
    if (!reaches_above) halves.above.clear();
    remove_repeats(halves.below);
    remove_repeats(halves.above);
    return halves;
}

Corner PolygonSplitter::cross(const Corner& a, const Corner& b, const Line& line) {
    const double from_a = line.along_normal(a);
    const double fraction = (line.offset - from_a) / (line.along_normal(b) - from_a);
    const glm::dvec3 from = vertices_[a.vertex];
    const glm::dvec3 at = from + fraction * (vertices_[b.vertex] - from);
    return corner(new_vertices_ == NewVertices::welded ? vertices_.add(at)
                                                       : vertices_.add_apart(at));
}

}  // namespace hemirad::meshing
