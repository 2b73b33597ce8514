#include "scene/cut_out.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

namespace hemirad {
namespace {

/// Of the longest side: corners this near to a line lie on it.
constexpr double kPrecision = 1e-9;
/// Coordinates of files are decimals with few digits.
constexpr double kFilePrecision = 1e-5;

double longest_side(const Outline& outline) {
    double longest = 0;
    for (std::size_t i = 0; i < outline.size(); ++i)
        longest = std::max(longest, glm::distance(outline[i], outline[(i + 1) % outline.size()]));
    return longest;
}

/// The side of an outline's edge, and how far from it; positive within.
struct EdgeSide {
    glm::dvec3 at, inwards;
    double precision;

    double distance(const glm::dvec3& p) const {
        const double d = glm::dot(inwards, p - at);
        return std::abs(d) <= precision ? 0 : d;
    }
};

std::vector<EdgeSide> edge_sides(const Outline& outline, double precision) {
    const glm::dvec3 normal = glm::normalize(doubled_area(outline));
    const double longest = longest_side(outline);
    std::vector<EdgeSide> sides;
    for (std::size_t edge = 0; edge < outline.size(); ++edge) {
        const glm::dvec3& a = outline[edge];
        const glm::dvec3& b = outline[(edge + 1) % outline.size()];
        sides.push_back({a, glm::normalize(glm::cross(normal, b - a)), precision * longest});
    }
    return sides;
}

/// Sutherland and Hodgman 1974: what lies where sign * distance >= 0.
Outline clipped(const Outline& polygon, const EdgeSide& side, double sign) {
    Outline kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
        const double from = sign * side.distance(a), to = sign * side.distance(b);
        if (from >= 0) kept.push_back(a);
        if (from * to < 0) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    return kept;
}

bool reaches_beyond(const Outline& polygon, const EdgeSide& side) {
    return std::ranges::any_of(polygon, [&](const auto& p) { return side.distance(p) < 0; });
}

bool lies_beyond(const Outline& polygon, const EdgeSide& side) {
    return std::ranges::all_of(polygon, [&](const auto& p) { return side.distance(p) < 0; });
}

/// Along each edge of the hole what lies beyond it is a piece; what is left at the end is within.
void cut_out_of(Outline polygon, std::span<const EdgeSide> hole, std::vector<Outline>& pieces) {
    for (const EdgeSide& side : hole) {
        if (!reaches_beyond(polygon, side)) continue;
        if (lies_beyond(polygon, side)) {
            pieces.push_back(std::move(polygon));
            return;
        }
        pieces.push_back(clipped(polygon, side, -1));
        polygon = clipped(polygon, side, 1);
        if (polygon.size() < 3) return;
    }
}

}  // namespace

glm::dvec3 doubled_area(std::span<const glm::dvec3> outline) {
    glm::dvec3 doubled{};
    for (std::size_t i = 2; i < outline.size(); ++i)
        doubled += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    return doubled;
}

bool is_in_plane_of(const Outline& outer, const Outline& inner) {
    const glm::dvec3 normal = glm::normalize(doubled_area(outer));
    const double precision = kFilePrecision * longest_side(outer);
    return std::ranges::all_of(inner, [&](const auto& p) {
        return std::abs(glm::dot(normal, p - outer[0])) <= precision;
    });
}

bool encloses(const Outline& outer, const Outline& inner) {
    return std::ranges::none_of(edge_sides(outer, kFilePrecision),
                                [&](const EdgeSide& side) { return reaches_beyond(inner, side); });
}

std::vector<Outline> cut_out(const Outline& polygon, std::span<const Outline> holes) {
    std::vector<Outline> pieces{polygon};
    for (const Outline& hole : holes) {
        const auto sides = edge_sides(hole, kPrecision);
        std::vector<Outline> cut;
        cut.reserve(pieces.size());
        for (Outline& piece : pieces) cut_out_of(std::move(piece), sides, cut);
        pieces = std::move(cut);
    }
    return pieces;
}

}  // namespace hemirad
