#include "scene/edges.h"

namespace hemirad::meshing {

std::vector<Edge> edges_of(const FlatFaces& faces) {
    std::vector<Edge> edges;
    edges.reserve(faces.corners.size());
    for (std::uint32_t flat = 0; flat < faces.flats.size(); ++flat) {
        const auto outline = faces.outline(faces.flats[flat]);
        for (std::size_t i = 0; i < outline.size(); ++i)
            edges.emplace_back(outline[i], outline[(i + 1) % outline.size()], flat);
    }
    sort_edges(edges);
    return edges;
}

}  // namespace hemirad::meshing
