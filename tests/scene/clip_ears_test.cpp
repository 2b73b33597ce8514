#include "scene/clip_ears.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace hemirad::test::clip_ears_test {
namespace {

using meshing::clip_ears;
using meshing::Corner;
using meshing::Polygon;
using meshing::turn;
using Triangle = std::array<Corner, 3>;
using Vertices = std::array<std::uint32_t, 3>;

constexpr double kPrecision = 1e-9;

Triangle about(const Polygon& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    return {polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n]};
}

bool blocks(const Triangle& corner, const Triangle& ear) {
    const auto& [a, b, c] = corner;
    if (turn(a, b, c) > 0) return false;
    for (int i = 0; i < 3; ++i)
        if (ear[i].vertex == b.vertex || turn(ear[i], ear[(i + 1) % 3], b) < 0) return false;
    return true;
}

bool is_ear(const Polygon& polygon, const Triangle& ear) {
    const auto& [a, b, c] = ear;
    if (turn(a, b, c) <= 0 || meshing::thickness({a, b, c}) <= kPrecision) return false;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        if (blocks(about(polygon, i), ear)) return false;
    return true;
}

/// Looks at every corner for every corner, each time.
std::vector<Vertices> clipped_patiently(Polygon polygon) {
    std::vector<Vertices> triangles;
    while (polygon.size() > 2) {
        std::size_t i = 0;
        while (i < polygon.size() && !is_ear(polygon, about(polygon, i))) ++i;
        if (i < polygon.size()) {
            const auto [a, b, c] = about(polygon, i);
            triangles.push_back({a.vertex, b.vertex, c.vertex});
        } else {
            const auto is_straight = [&](std::size_t k) {
                const auto [a, b, c] = about(polygon, k);
                return std::abs(bulge(a, b, c)) <= kPrecision;
            };
            for (i = 0; i < polygon.size() && !is_straight(i);) ++i;
        }
        if (i == polygon.size()) return {};
        polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return triangles;
}

std::vector<Vertices> clipped(const Polygon& polygon) {
    std::vector<Vertices> triangles;
    for (const auto& [a, b, c] : clip_ears(polygon, kPrecision))
        triangles.push_back({a.vertex, b.vertex, c.vertex});
    return triangles;
}

/// Radii of whole quarters, so that corners lie in line and on each other's edges.
Polygon star(std::uint32_t count, std::mt19937& random) {
    Polygon polygon;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count, radius = 0.25 * (1 + random() % 4);
        polygon.push_back({i, {radius * std::cos(angle), radius * std::sin(angle)}});
    }
    return polygon;
}

/// Corners anywhere on a grid: mostly not simple, with vertices that repeat.
Polygon scribble(std::uint32_t count, std::mt19937& random) {
    Polygon polygon;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t x = random() % 6, y = random() % 6;
        polygon.push_back({6 * y + x, {x, y}});
    }
    return polygon;
}

Polygon spiral(std::uint32_t count) {
    Polygon polygon;
    for (std::uint32_t i = 0; i < count; ++i) {
        const bool outer = i < count / 2;
        const double t = 2.0 * (outer ? i : count - 1 - i) / count, angle = 60 * t;
        const double radius = 0.2 + t - (outer ? 0 : 0.04);
        polygon.push_back({i, {radius * std::cos(angle), radius * std::sin(angle)}});
    }
    return polygon;
}

TEST(ClipEars, TakesTheSameEarsAsOneThatLooksAtAllCornersEachTime) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const Polygon simple = star(4 + random() % 30, random);
        const Polygon wild = scribble(4 + random() % 12, random);

        EXPECT_EQ(clipped(simple), clipped_patiently(simple)) << i;
        EXPECT_EQ(clipped(wild), clipped_patiently(wild)) << i;
    }
    EXPECT_EQ(clipped(spiral(100)), clipped_patiently(spiral(100)));
}

/// All corners for each ear would be fifty million.
TEST(ClipEars, LooksAtFewOfTheCornersOfASpiral) {
    constexpr std::uint32_t kCorners = 10'000;
    std::size_t looks = 0;

    const auto triangles = clip_ears(spiral(kCorners), kPrecision, &looks);

    EXPECT_EQ(triangles.size(), kCorners - 2);
    EXPECT_LT(looks, kCorners * kCorners / 20);
}

}  // namespace
}  // namespace hemirad::test::clip_ears_test
