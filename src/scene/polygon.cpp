#include "scene/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace hemirad::meshing {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double longest_edge(const Polygon& polygon) {
    double longest = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        longest =
            std::max(longest, glm::distance(polygon[i].at, polygon[(i + 1) % polygon.size()].at));
    return longest;
}

bool cross_inside(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
    return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

// Sutherland and Hodgman (1974) against one edge, from a to b.
Polygon left_of(const Polygon& polygon, const Corner& a, const Corner& b) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& p = polygon[i];
        const Corner& q = polygon[(i + 1) % polygon.size()];
        const double p_side = turn(a, b, p);
        const double q_side = turn(a, b, q);
        if (p_side >= 0) kept.push_back(p);
        if (p_side * q_side < 0)
            kept.push_back({p.vertex, p.at + (q.at - p.at) * (p_side / (p_side - q_side))});
    }
    return kept;
}

bool apart(const Polygon& a, const Polygon& b, int axis) {
    const auto along = [&](const Corner& corner) { return corner.at[axis]; };
    return along(*std::ranges::max_element(a, {}, along)) <
               along(*std::ranges::min_element(b, {}, along)) ||
           along(*std::ranges::max_element(b, {}, along)) <
               along(*std::ranges::min_element(a, {}, along));
}

std::vector<Polygon> fan_of_quads(const Polygon& polygon, std::size_t start) {
    const std::size_t n = polygon.size();
    const auto corner = [&](std::size_t i) { return polygon[(start + i) % n]; };
    std::vector<Polygon> parts;
    for (std::size_t i = 1; i + 1 < n; i += 2) {
        parts.push_back({corner(0), corner(i), corner(i + 1)});
        if (i + 2 < n) parts.back().push_back(corner(i + 2));
    }
    return parts;
}

double thinnest(const std::vector<Polygon>& parts) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& part : parts) least = std::min(least, thickness(part));
    return least;
}

std::array<Corner, 3> corner_triangle(const Polygon& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    return {polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]};
}

bool points_up(const glm::dvec2& edge) { return edge.y > 0 || (edge.y == 0 && edge.x > 0); }

}  // namespace

double turn(const Corner& a, const Corner& b, const Corner& c) {
    return cross(b.at - a.at, c.at - a.at);
}

double area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        twice += turn(polygon[0], polygon[i], polygon[i + 1]);
    return twice / 2;
}

double thickness(const Polygon& polygon) {
    const double longest = longest_edge(polygon);
    return longest > 0 ? 2 * area(polygon) / longest : 0;
}

double bulge(const Corner& a, const Corner& b, const Corner& c) {
    const double base = glm::distance(a.at, c.at);
    return base > 0 ? turn(a, b, c) / base : 0;
}

Polygon without_straight_corners(Polygon polygon, double precision) {
    std::size_t i = 0;
    for (std::size_t kept = 0; polygon.size() > 2 && kept < polygon.size();) {
        const auto [a, b, c] = corner_triangle(polygon, i);
        if (std::abs(bulge(a, b, c)) <= precision) {
            polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
            kept = 0;
        } else {
            ++i;
            ++kept;
        }
        i %= polygon.size();
    }
    return polygon;
}

// Where every corner turns left, the outline goes round as often as its edges come to point
// upwards.
bool is_convex(const Polygon& polygon) {
    const std::size_t n = polygon.size();
    if (n < 3) return false;
    int rounds = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto [a, b, c] = corner_triangle(polygon, i);
        if (turn(a, b, c) <= 0) return false;
        if (!points_up(b.at - a.at) && points_up(c.at - b.at)) ++rounds;
    }
    return rounds == 1;
}

bool crosses_itself(const Polygon& polygon) {
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i + 2 < n; ++i)
        for (std::size_t j = i + 2; j < n; ++j)
            if (cross_inside(polygon[i], polygon[i + 1], polygon[j], polygon[(j + 1) % n]))
                return true;
    return false;
}

double common_area(const Polygon& a, const Polygon& b) {
    if (apart(a, b, 0) || apart(a, b, 1)) return 0;
    Polygon common = a;
    for (std::size_t i = 0; i < b.size() && common.size() > 2; ++i)
        common = left_of(common, b[i], b[(i + 1) % b.size()]);
    return common.size() > 2 ? area(common) : 0;
}

std::vector<Polygon> cut_into_quads(const Polygon& polygon, double precision) {
    // Past a few corners one start is as good as another, and trying all would be quadratic.
    constexpr std::size_t kMostStarts = 8;
    std::vector<Polygon> best = fan_of_quads(polygon, 0);
    const std::size_t starts = polygon.size() > 4 ? std::min(polygon.size(), kMostStarts) : 1;
    for (std::size_t start = 1; start < starts; ++start) {
        auto parts = fan_of_quads(polygon, start);
        if (thinnest(parts) > thinnest(best)) best = std::move(parts);
    }
    std::erase_if(best, [&](const Polygon& part) { return thickness(part) <= precision; });
    return best;
}

}  // namespace hemirad::meshing
