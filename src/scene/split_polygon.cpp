#include "scene/split_polygon.h"

#include <algorithm>

namespace hemirad::meshing {

void remove_repeats(Polygon& polygon) {
    const auto repeated = std::ranges::unique(polygon, {}, &Corner::vertex);
    polygon.erase(repeated.begin(), repeated.end());
    while (polygon.size() > 1 && polygon.front().vertex == polygon.back().vertex)
        polygon.pop_back();
    if (polygon.size() < 3) polygon.clear();
}

Halves<Polygon> PolygonSplitter::split(const Polygon& polygon, const Line& line, double slack) {
    auto halves =
        meshing::split(polygon, line, slack,
                       [&](const Corner& a, const Corner& b, double f) { return cross(a, b, f); });
    remove_repeats(halves.below);
    remove_repeats(halves.above);
    return halves;
}

Corner PolygonSplitter::cross(const Corner& a, const Corner& b, double fraction) {
    const glm::dvec3 from = vertices_[a.vertex];
    const auto vertex = vertices_.add_apart(from + fraction * (vertices_[b.vertex] - from));
    return {vertex, frame_.project(vertices_[vertex])};
}

}  // namespace hemirad::meshing
