#include "scene/lay_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "errors.h"
#include "scene/edges.h"
#include "scene/frame.h"
#include "scene/input_file.h"

namespace hemirad::meshing {
namespace {

using Vertices = std::vector<glm::dvec3>;

struct DirectedEdge {
    std::uint32_t from, to;
};

std::vector<DirectedEdge> all_edges(const FlatFaces& faces, const Group& group) {
    std::vector<DirectedEdge> edges;
    for (const std::uint32_t flat : group) {
        const auto outline = faces.outline(faces.flats[flat]);
        for (std::size_t i = 0; i < outline.size(); ++i)
            edges.push_back({outline[i], outline[(i + 1) % outline.size()]});
    }
    return edges;
}

// Edges that one flat of the group has and no other, in the order of the outlines.
std::vector<DirectedEdge> boundary_of(const FlatFaces& faces, const Group& group) {
    std::vector<DirectedEdge> edges = all_edges(faces, group);
    if (group.size() == 1) return edges;
    std::vector<Edge> sorted;
    for (std::uint32_t e = 0; e < edges.size(); ++e)
        sorted.emplace_back(edges[e].from, edges[e].to, e);
    sort_edges(sorted);
    std::vector<std::uint32_t> on_boundary;
    for_each_shared(sorted, [&](std::span<const Edge> shared) {
        if (shared.size() == 1) on_boundary.push_back(shared.front().owner);
    });
    std::ranges::sort(on_boundary);
    std::vector<DirectedEdge> boundary;
    for (const std::uint32_t e : on_boundary) boundary.push_back(edges[e]);
    return boundary.empty() ? edges : boundary;
}

DirectedEdge longest(const std::vector<DirectedEdge>& edges, const Vertices& vertices,
                     double precision) {
    DirectedEdge best = edges.front();
    double best_length = 0;
    for (const DirectedEdge& edge : edges) {
        const double length = glm::distance(vertices[edge.from], vertices[edge.to]);
        if (length <= best_length + precision) continue;
        best_length = length;
        best = edge;
    }
    return best;
}

glm::dvec3 normal_of(const FlatFaces& faces, const Group& group, const Vertices& vertices) {
    glm::dvec3 sum(0);
    for (const std::uint32_t flat : group)
        sum += area_vector(faces.outline(faces.flats[flat]), vertices);
    return sum / glm::length(sum);
}

struct Rectangle {
    glm::dvec2 low = glm::dvec2(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
};

Rectangle bounds(const FlatFaces& faces, const Group& group, const Vertices& vertices,
                 const Frame& frame) {
    Rectangle rectangle;
    for (const std::uint32_t flat : group)
        for (const std::uint32_t v : faces.outline(faces.flats[flat])) {
            const glm::dvec2 p = frame.project(vertices[v]);
            rectangle.low = glm::min(rectangle.low, p);
            rectangle.high = glm::max(rectangle.high, p);
        }
    return rectangle;
}

// A side that is longer than a whole number of cells by less than coordinates are precise gets no
// cell more.
double divisions(double side, double patch_size, double precision) {
    return std::max(1.0, std::ceil((side - precision) / patch_size));
}

struct CellCount {
    double columns, rows;
    const char *patch, *patches;  ///< what a cell holds
    double size;                  ///< m, as asked for
};

// Cell numbers fit 32 bits.
void check(const CellCount& cells, const Scene& scene, std::uint32_t object) {
    constexpr double kMostCells = 1e8;  // some 20 GB of patches
    if (cells.columns * cells.rows <= kMostCells) return;
    throw InputError(scene.file + ": " + cells.patch + " size " + number(cells.size) +
                     " m is too small: a surface of \"" + scene.objects[object] +
                     "\" would have more than 100 million " + cells.patches);
}

std::uint32_t least_factor(std::uint32_t number) {
    for (std::uint32_t factor = 2; factor * factor <= number; ++factor)
        if (number % factor == 0) return factor;
    return number;
}

Surface in_parts(const Scene& scene, Surface surface, const glm::dvec2& parts) {
    const double columns = parts.x * surface.columns, rows = parts.y * surface.rows;
    surface.cell_size /= parts;
    const double size = std::max(surface.cell_size.x, surface.cell_size.y);
    check({columns, rows, "element", "elements", size}, scene, surface.object);
    surface.columns = static_cast<std::uint32_t>(columns);
    surface.rows = static_cast<std::uint32_t>(rows);
    return surface;
}

}  // namespace

Surface lay_grid(const Scene& scene, const FlatFaces& faces, const Group& group,
                 const Vertices& vertices, const Precision& precision, double patch_size) {
    const Face& face = scene.faces[faces.flats[group.front()].face];
    const DirectedEdge base = longest(boundary_of(faces, group), vertices, precision.plane);
    const glm::dvec3& origin = vertices[base.from];
    const Frame frame =
        frame_along(origin, vertices[base.to] - origin, normal_of(faces, group, vertices));
    const auto [low, high] = bounds(faces, group, vertices, frame);
    const glm::dvec2 size = high - low;
    const double columns = divisions(size.x, patch_size, precision.plane);
    const double rows = divisions(size.y, patch_size, precision.plane);
    check({columns, rows, "patch", "patches", patch_size}, scene, face.object);
    Surface surface;
    surface.object = face.object;
    surface.material = face.material;
    surface.origin = origin + low.x * frame.u + low.y * frame.v;
    surface.u_axis = frame.u;
    surface.v_axis = frame.v;
    surface.normal = frame.normal;
    surface.columns = static_cast<std::uint32_t>(columns);
    surface.rows = static_cast<std::uint32_t>(rows);
    surface.cell_size = size / glm::dvec2(columns, rows);
    return surface;
}

Surface divide_cells(const Scene& scene, const Surface& surface, const Precision& precision,
                     double element_size) {
    const glm::dvec2 parts(divisions(surface.cell_size.x, element_size, precision.plane),
                           divisions(surface.cell_size.y, element_size, precision.plane));
    return in_parts(scene, surface, parts);
}

Surface halve_cells(const Scene& scene, const Surface& surface, std::uint32_t levels) {
    return in_parts(scene, surface, glm::dvec2(std::ldexp(1.0, static_cast<int>(levels))));
}

Surface part_cells(const Surface& surface, const Surface& elements) {
    const std::uint32_t across = least_factor(elements.columns / surface.columns);
    const std::uint32_t up = least_factor(elements.rows / surface.rows);
    Surface parts = surface;
    parts.columns *= across;
    parts.rows *= up;
    parts.cell_size /= glm::dvec2(across, up);
    return parts;
}

}  // namespace hemirad::meshing
