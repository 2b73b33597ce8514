#include "scene/flat_faces.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/clip_ears.h"
#include "scene/face_warnings.h"
#include "scene/frame.h"
#include "scene/polygon.h"

namespace hemirad::meshing {
namespace {

using Vertices = std::vector<glm::dvec3>;
using Outline = std::span<const std::uint32_t>;

// Distance of the farthest corner from the line through the first and the one farthest from it.
double width_of(Outline outline, const Vertices& vertices) {
    const glm::dvec3& base = vertices[outline[0]];
    glm::dvec3 along(0);
    for (const std::uint32_t v : outline)
        if (const auto d = vertices[v] - base; glm::dot(d, d) > glm::dot(along, along)) along = d;
    double widest = 0;
    for (const std::uint32_t v : outline)
        widest = std::max(widest, glm::length(glm::cross(along, vertices[v] - base)));
    return widest / glm::length(along);
}

// Against the plane through the mean corner, which halves the largest deviation of a warped quad.
bool is_planar(Outline outline, const Vertices& vertices, const glm::dvec3& normal,
               double precision) {
    if (outline.size() == 3) return true;
    const glm::dvec3& base = vertices[outline[0]];
    glm::dvec3 mean(0);  // from the base: far from the origin sums would lose digits
    for (const std::uint32_t v : outline) mean += (vertices[v] - base) / double(outline.size());
    return std::ranges::all_of(outline, [&](std::uint32_t v) {
        return std::abs(glm::dot(normal, vertices[v] - base - mean)) <= precision;
    });
}

// Along the axis that lies flattest in the plane: an edge of a warped face may stand upright on it.
Polygon project(Outline outline, const Vertices& vertices, const glm::dvec3& normal) {
    const glm::dvec3 upright = glm::abs(normal);
    const bool x_is_flattest = upright.x <= upright.y && upright.x <= upright.z;
    const glm::dvec3 axis = x_is_flattest            ? glm::dvec3(1, 0, 0)
                            : upright.y <= upright.z ? glm::dvec3(0, 1, 0)
                                                     : glm::dvec3(0, 0, 1);
    const Frame frame = frame_along(vertices[outline[0]], axis, normal);
    Polygon polygon;
    for (const std::uint32_t v : outline) polygon.push_back({v, frame.project(vertices[v])});
    return polygon;
}

std::vector<std::array<Corner, 3>> split_along_shorter_diagonal(const Polygon& quad,
                                                                const Vertices& vertices) {
    const auto& [a, b, c, d] = std::array{quad[0], quad[1], quad[2], quad[3]};
    const double ac = glm::distance(vertices[a.vertex], vertices[c.vertex]);
    const double bd = glm::distance(vertices[b.vertex], vertices[d.vertex]);
    if (ac <= bd) return {{a, b, c}, {a, c, d}};
    return {{a, b, d}, {b, c, d}};
}

class Flattener {
  public:
    Flattener(const Scene& scene, const Outlines& outlines, const Vertices& vertices,
              const Precision& precision)
        : outlines_(outlines),
          vertices_(vertices),
          precision_(precision.plane),
          twins_(find_twins(outlines)),
          no_area_(scene, "has no area, or is no wider than twice the weld: dropped"),
          crossing_(scene, "crosses itself: dropped"),
          repeated_(scene, "repeats another face: dropped"),
          warped_(scene, "is not planar: split into triangles") {}

    FlatFaces run() {
        result_.corners.reserve(outlines_.corners.size());
        result_.flats.reserve(outlines_.face_count());
        for (std::uint32_t face = 0; face < outlines_.face_count(); ++face) flatten(face);
        for (const auto* kind : {&no_area_, &crossing_, &repeated_, &warped_})
            kind->append_to(result_.warnings);
        result_.degenerate_count = no_area_.count();
        result_.crossing_count = crossing_.count();
        result_.split_count = warped_.count();
        result_.duplicate_count = repeated_.count();
        return std::move(result_);
    }

  private:
    void flatten(std::uint32_t face) {
        const Outline outline = outlines_[face];
        if (outline.empty() || width_of(outline, vertices_) <= precision_)
            return no_area_.add(face);
        if (twins_[face] == Twin::repeats) return repeated_.add(face);
        const glm::dvec3 area = area_vector(outline, vertices_);
        if (2 * glm::length(area) <= precision_ * longest_edge(outline, vertices_))
            return crossing_.add(face);

        const glm::dvec3 normal = area / glm::length(area);
        const Polygon polygon = project(outline, vertices_, normal);
        const bool planar = is_planar(outline, vertices_, normal, precision_);
        const bool convex = is_convex(without_straight_corners(polygon, precision_));
        if (planar && convex) return add_flat(face, outline, {});
        split(face, polygon, planar, convex);
    }

    void split(std::uint32_t face, const Polygon& polygon, bool planar, bool convex) {
        if (!convex && crosses_itself(polygon)) return crossing_.add(face);
        const bool warped_quad = convex && polygon.size() == 4;
        const auto triangles = warped_quad ? split_along_shorter_diagonal(polygon, vertices_)
                                           : clip_ears(polygon, precision_);
        if (triangles.empty()) return crossing_.add(face);
        if (planar) return add_flat(face, outlines_[face], triangles);
        warped_.add(face);
        for (const auto& [a, b, c] : triangles) {
            const std::array corners{a.vertex, b.vertex, c.vertex};
            if (width_of(corners, vertices_) > precision_) add_flat(face, corners, {});
        }
    }

    void add_flat(std::uint32_t face, Outline outline,
                  const std::vector<std::array<Corner, 3>>& triangles) {
        result_.flats.push_back({face, static_cast<std::uint32_t>(result_.corners.size()),
                                 static_cast<std::uint32_t>(outline.size()),
                                 static_cast<std::uint32_t>(result_.triangles.size()),
                                 static_cast<std::uint32_t>(triangles.size()),
                                 twins_[face] == Twin::reversed});
        result_.corners.insert(result_.corners.end(), outline.begin(), outline.end());
        for (const auto& [a, b, c] : triangles)
            result_.triangles.push_back({a.vertex, b.vertex, c.vertex});
    }

    const Outlines& outlines_;
    const Vertices& vertices_;
    double precision_;
    std::vector<Twin> twins_;
    FaceWarnings no_area_, crossing_, repeated_, warped_;
    FlatFaces result_;
};

}  // namespace

std::vector<std::span<const std::uint32_t>> FlatFaces::pieces(const Flat& flat) const {
    if (flat.triangle_count == 0) return {outline(flat)};
    std::vector<std::span<const std::uint32_t>> pieces;
    for (std::uint32_t i = 0; i < flat.triangle_count; ++i)
        pieces.emplace_back(triangles[flat.first_triangle + i]);
    return pieces;
}

glm::dvec3 area_vector(std::span<const std::uint32_t> outline, const Vertices& vertices) {
    const glm::dvec3& base = vertices[outline[0]];
    glm::dvec3 twice(0);
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
        twice += glm::cross(vertices[outline[i]] - base, vertices[outline[i + 1]] - base);
    return 0.5 * twice;
}

double longest_edge(std::span<const std::uint32_t> outline, const Vertices& vertices) {
    double longest = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
        longest = std::max(longest, glm::distance(vertices[outline[i]],
                                                  vertices[outline[(i + 1) % outline.size()]]));
    return longest;
}

FlatFaces flatten(const Scene& scene, const Outlines& outlines, const Vertices& vertices,
                  const Precision& precision) {
    return Flattener(scene, outlines, vertices, precision).run();
}

}  // namespace hemirad::meshing
