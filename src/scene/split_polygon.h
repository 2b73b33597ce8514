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
struct Halves {
    Polygon below, above;
};

/// Whether a new vertex may be drawn to any that is near, as welding does, or stays on the edge
/// that it divides, to which neighbours that are not cut have no vertex.
enum class NewVertices { welded, on_edges };

/// Cuts polygons of one plane in two. New vertices go to the welder.
///
/// A vertex within `slack` of a line counts as on it and stays where it is, so nothing is moved and
/// no sliver arises beside a line. Both polygons of an edge that crosses a line get the same vertex
/// there: the second one's differs by rounding only and is welded.
class PolygonSplitter {
  public:
    PolygonSplitter(const Frame& frame, VertexWelder& vertices, NewVertices new_vertices)
        : frame_(frame), vertices_(vertices), new_vertices_(new_vertices) {}

    Corner corner(std::uint32_t vertex) const {
        return {vertex, frame_.project(vertices_[vertex])};
    }
    Halves split(const Polygon& polygon, const Line& line, double slack);

  private:
    Corner cross(const Corner& a, const Corner& b, const Line& line);

    Frame frame_;
    VertexWelder& vertices_;
    NewVertices new_vertices_;
};

}  // namespace hemirad::meshing
