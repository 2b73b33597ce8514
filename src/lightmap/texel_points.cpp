#include "lightmap/texel_points.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace hemirad {
namespace {

/// A patch on its surface: (s, t), counter-clockwise.
struct Outline {
    std::array<glm::dvec2, 4> corners;
    std::size_t count;

    /// Of its edges, of which a repeated corner has none: from where, and the unit vector inwards.
    template <class Visit>
    void for_each_edge(const Visit& visit) const {
        for (std::size_t k = 0; k < count; ++k) {
            const glm::dvec2 along = corners[(k + 1) % count] - corners[k];
            const double length = glm::length(along);
            if (length > 0) visit(corners[k], glm::dvec2(-along.y, along.x) / length);
        }
    }

    /// How far inside the nearest edge.
    double depth_of(const glm::dvec2& place) const {
        double least = std::numeric_limits<double>::infinity();
        for_each_edge([&](const glm::dvec2& from, const glm::dvec2& inwards) {
            least = std::min(least, glm::dot(inwards, place - from));
        });
        return least;
    }
};

glm::dvec2 place_on(const Surface& surface, const glm::dvec3& point) {
    const glm::dvec3 offset = point - surface.origin;
    return {glm::dot(offset, surface.u_axis), glm::dot(offset, surface.v_axis)};
}

Outline outline_of(const Mesh& mesh, const Patch& patch) {
    Outline outline{{}, patch.is_triangle() ? std::size_t{3} : std::size_t{4}};
    for (std::size_t k = 0; k < outline.count; ++k)
        outline.corners[k] =
            place_on(mesh.surfaces[patch.surface], mesh.vertices[patch.corners[k]]);
    return outline;
}

/// From edge to edge until it is inside of all, or, in a corner too sharp for that, on the way to
/// the centre.
glm::dvec2 moved_inside(const Outline& outline, const glm::dvec2& centre, glm::dvec2 place,
                        double depth) {
    constexpr int kRounds = 16;
    const double possible = std::min(depth, 0.5 * outline.depth_of(centre));
    for (int round = 0; round < kRounds && outline.depth_of(place) < possible; ++round)
        outline.for_each_edge([&](const glm::dvec2& from, const glm::dvec2& inwards) {
            const double missing = possible - glm::dot(inwards, place - from);
            if (missing > 0) place += missing * inwards;
        });
    const double reached = outline.depth_of(place), whole = outline.depth_of(centre);
    if (reached < 0) place += (centre - place) * ((possible - reached) / (whole - reached));
    return place;
}

}  // namespace

SurfacePoint point_on_patch(const Mesh& mesh, std::uint32_t index, const glm::dvec2& place,
                            double texel) {
    constexpr double kInside = 0.01, kFromOutside = 0.25;
    const Patch& patch = mesh.patches[index];
    const Surface& surface = mesh.surfaces[patch.surface];
    const glm::dvec3 centroid = mesh.centroid(patch), normal = mesh.normal(patch);
    const Outline outline = outline_of(mesh, patch);
    const double depth = (outline.depth_of(place) < 0 ? kFromOutside : kInside) * texel;
    const glm::dvec2 inside = moved_inside(outline, place_on(surface, centroid), place, depth);
    glm::dvec3 point = surface.origin + inside.x * surface.u_axis + inside.y * surface.v_axis;
    // Corners may lie a weld's width off their surface's plane.
    point += normal * glm::dot(normal, centroid - point);
    return {point, index, 0};
}

}  // namespace hemirad
