#include "scene/find_contacts.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace hemirad::meshing {
namespace {

/// Bounds the time that faces which all cover each other take; an edge lies on one or two surfaces.
constexpr double kFewestLooks = 4e6, kLooksAnEdge = 16;

using Shared = std::span<const Edge>;

std::vector<std::uint32_t> groups_of_flats(const std::vector<Group>& groups, std::size_t flats) {
    std::vector<std::uint32_t> group_of_flat(flats);
    for (std::uint32_t g = 0; g < groups.size(); ++g)
        for (const std::uint32_t flat : groups[g]) group_of_flat[flat] = g;
    return group_of_flat;
}

// What a surface has on both sides of an edge lies within its outline.
bool is_outline_of(std::uint32_t group, Shared edge, const std::vector<std::uint32_t>& groups) {
    return 1 == std::ranges::count_if(
                    edge, [&](const Edge& side) { return groups[side.owner] == group; });
}

std::vector<Shared> outline_edges(Shared sorted, const std::vector<std::uint32_t>& groups) {
    std::vector<Shared> outlines;
    for_each_shared(sorted, [&](Shared edge) {
        if (std::ranges::any_of(edge, [&](const Edge& side) {
                return is_outline_of(groups[side.owner], edge, groups);
            }))
            outlines.push_back(edge);
    });
    return outlines;
}

std::vector<Segment> segments_of(const std::vector<Shared>& edges) {
    std::vector<Segment> segments;
    segments.reserve(edges.size());
    for (const Shared& edge : edges) segments.push_back({edge[0].low(), edge[0].high()});
    return segments;
}

// Cells that it runs through, and one for having been found.
double looks_at(const Contact& contact, const Surface& surface) {
    const glm::dvec2 cells = glm::abs(contact.to - contact.from) / surface.cell_size;
    return 1 + std::min(cells.x, 1.0 * surface.columns) + std::min(cells.y, 1.0 * surface.rows);
}

Slab slab_of(const Surface& surface, double precision) {
    return {{surface.origin, surface.u_axis, surface.v_axis, surface.normal},
            surface.cell_size * glm::dvec2(surface.columns, surface.rows),
            precision};
}

}  // namespace

ContactFinder::ContactFinder(const FlatFaces& faces, std::span<const Edge> edges,
                             const std::vector<Group>& groups,
                             const std::vector<glm::dvec3>& vertices, const Precision& precision)
    : faces_(faces),
      vertices_(vertices),
      precision_(precision.plane),
      group_of_flat_(groups_of_flats(groups, faces.flats.size())),
      outlines_(outline_edges(edges, group_of_flat_)),
      tree_(vertices, segments_of(outlines_)),
      looks_left_(kFewestLooks + kLooksAnEdge * double(outlines_.size())),
      wall_looks_left_(looks_left_) {}

std::vector<Contact> ContactFinder::on(std::uint32_t group, const Surface& surface, Sides sides) {
    const Slab slab = slab_of(surface, precision_);
    std::vector<Contact> contacts;
    for (const std::uint32_t found : tree_.in(slab)) {
        const Shared& edge = outlines_[found];
        if (!ends_on(edge, group, surface, sides)) continue;
        contacts.push_back({slab.frame.project(vertices_[edge[0].low()]),
                            slab.frame.project(vertices_[edge[0].high()])});
        looks_left_ -= looks_at(contacts.back(), surface);
        if (!complete()) return {};
    }
    return contacts;
}

std::vector<Wall> ContactFinder::walls_on(std::uint32_t group, const Surface& surface,
                                          Sides sides) {
    if (wall_looks_left_ <= 0) return {};
    const Slab slab = slab_of(surface, precision_);
    std::vector<Wall> walls;
    for (const std::uint32_t found : tree_.in(slab)) {
        const Shared& edge = outlines_[found];
        wall_looks_left_ -= double(edge.size());
        if (std::ranges::any_of(edge, [&](const Edge& side) {
                return group_of_flat_[side.owner] != group && stands_up(side.owner, surface, sides);
            }))
            walls.push_back({slab.frame.project(vertices_[edge[0].low()]),
                             slab.frame.project(vertices_[edge[0].high()])});
    }
    return walls;
}

bool ContactFinder::ends_on(Shared edge, std::uint32_t group, const Surface& surface,
                            Sides sides) const {
    if (is_outline_of(group, edge, group_of_flat_)) return false;
    return std::ranges::any_of(edge, [&](const Edge& side) {
        const std::uint32_t other = group_of_flat_[side.owner];
        return other != group && is_outline_of(other, edge, group_of_flat_) &&
               reaches(side.owner, surface, sides);
    });
}

ContactFinder::Heights ContactFinder::heights(std::uint32_t flat, const Surface& surface) const {
    Heights heights;
    for (const std::uint32_t v : faces_.outline(faces_.flats[flat])) {
        const double height = glm::dot(vertices_[v] - surface.origin, surface.normal);
        heights.low = std::min(heights.low, height);
        heights.high = std::max(heights.high, height);
    }
    return heights;
}

bool ContactFinder::reaches(std::uint32_t flat, const Surface& surface, Sides sides) const {
    const auto [low, high] = heights(flat, surface);
    return high > precision_ || low >= -precision_ || sides == Sides::both;
}

bool ContactFinder::stands_up(std::uint32_t flat, const Surface& surface, Sides sides) const {
    const auto [low, high] = heights(flat, surface);
    return high > precision_ || (low < -precision_ && sides == Sides::both);
}

}  // namespace hemirad::meshing
