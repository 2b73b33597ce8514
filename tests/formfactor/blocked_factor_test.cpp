#include "formfactor/blocked_factor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formfactor/shapes.h"
#include "reference/closed_forms.h"

namespace hemirad::blocked_factor_test {
namespace {

using test::facing_down;
using test::facing_up;
using test::normal_of;
using test::random_point;
using test::random_triangle;

using Polygons = std::vector<ConvexPolygon>;

const ConvexPolygon kFloor = facing_up(0, 0, 1, 1), kCeiling = facing_down(0, 0, 1, 1, 1);

double factor(const ConvexPolygon& from, const ConvexPolygon& to, const Polygons& blockers,
              double target = 1e-5) {
    return blocked_polygon_to_polygon(from, to, blockers, target).value;
}

// Front and back.
Polygons sheet(const ConvexPolygon& polygon) { return {polygon, test::reversed(polygon)}; }

// The segment meets the front of the triangle, seen from `a` (Moeller and Trumbore 1997).
bool blocks(const ConvexPolygon& t, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a, e1 = t[1] - t[0], e2 = t[2] - t[0];
    const double determinant = -glm::dot(glm::cross(e1, e2), along);
    if (determinant <= 0) return false;
    const glm::dvec3 gap = a - t[0], moment = glm::cross(gap, along);
    const double u = glm::dot(e2, moment), v = -glm::dot(e1, moment);
    const double depth = glm::dot(glm::cross(e1, e2), gap);
    return u >= 0 && v >= 0 && u + v <= determinant && depth > 0 && depth < determinant;
}

// Random within each of `cells` * `cells` equal parts.
std::vector<glm::dvec3> points_on(const ConvexPolygon& triangle, int cells, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<glm::dvec3> points;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const double s = std::sqrt((i + uniform(random)) / cells);
            const double t = (j + uniform(random)) / cells;
            points.push_back((1 - s) * triangle[0] + s * (1 - t) * triangle[1] +
                             s * t * triangle[2]);
        }
    return points;
}

// Kernel and rays between points on both triangles.
double by_rays(const ConvexPolygon& from, const ConvexPolygon& to, const Polygons& blockers,
               int cells, std::mt19937& random) {
    const glm::dvec3 from_normal = normal_of(from), to_normal = normal_of(to);
    const auto to_points = points_on(to, cells, random);
    double sum = 0;
    for (const glm::dvec3& x : points_on(from, cells, random))
        for (const glm::dvec3& y : to_points) {
            const glm::dvec3 gap = y - x;
            const double near = glm::dot(from_normal, gap), far = -glm::dot(to_normal, gap);
            if (near <= 0 || far <= 0) continue;
            const bool hidden = std::ranges::any_of(
                blockers, [&](const ConvexPolygon& blocker) { return blocks(blocker, x, y); });
            if (!hidden) sum += near * far / std::pow(glm::dot(gap, gap), 2);
        }
    return sum * test::area_of(to) / (M_PI * std::pow(double(cells), 4));
}

struct Triple {
    ConvexPolygon from, to;
    Polygons blockers;
};

// Two triangles that see each other, and `sheets` sheets around and between.
Triple random_triple(std::mt19937& random, int sheets, double size) {
    while (true) {
        Triple triple{random_triangle(random, {0, 0, -0.5}, size),
                      random_triangle(random, {0, 0, 0.5}, size),
                      {}};
        if (polygon_to_polygon(triple.from, triple.to) < 1e-5) continue;
        for (int k = 0; k < sheets; ++k)
            for (const auto& side : sheet(random_triangle(random, random_point(random, 0.5), size)))
                triple.blockers.push_back(side);
        return triple;
    }
}

TEST(BlockedFactor, IsTheClosedFormWithNothingBetween) {
    const auto free = blocked_polygon_to_polygon(kFloor, kCeiling, {}, 1e-4);

    EXPECT_NEAR(free.value, reference::parallel_rectangles(1, 1, 1), 1e-10);
    EXPECT_LE(free.error, 1e-8);
}

TEST(BlockedFactor, IsTheClosedFormWhereNoBlockerCanMatter) {
    const Polygons beside = {facing_down(1.1, 0, 2, 1, 0.5), facing_down(0, 0, 1, 1, 1.5),
                             facing_down(0, 0, 1, 1, -0.5), kCeiling, kFloor};

    const auto free = blocked_polygon_to_polygon(kFloor, kCeiling, beside, 1e-4);

    EXPECT_EQ(free.value, polygon_to_polygon(kFloor, kCeiling));
    EXPECT_LE(free.error, 1e-8);
}

TEST(BlockedFactor, IsNothingBehindALargePlate) {
    const auto hidden = blocked_polygon_to_polygon(kFloor, kCeiling,
                                                   Polygons{facing_down(-1, -1, 2, 2, 0.5)}, 1e-4);

    EXPECT_EQ(hidden.value, 0);
    EXPECT_LE(hidden.error, 1e-8);
}

TEST(BlockedFactor, IsNothingBehindTwoPlatesThatHideTogether) {
    const auto hidden = blocked_polygon_to_polygon(
        kFloor, kCeiling,
        Polygons{facing_down(-1, -1, 0.5, 2, 0.5), facing_down(0.5, -1, 2, 2, 0.5)}, 1e-4);

    EXPECT_NEAR(hidden.value, 0, 1e-12);
}

TEST(BlockedFactor, IsWholeBehindAPlateThatFacesAway) {
    EXPECT_EQ(factor(kFloor, kCeiling, {facing_up(-1, -1, 2, 2, 0.5)}),
              polygon_to_polygon(kFloor, kCeiling));
}

// A plate that lies on the ceiling hides what it covers.
TEST(BlockedFactor, OfACeilingHalfCoveredIsThatOfTheOtherHalf) {
    const double half = reference::parallel_rectangles({0, 1}, {0, 1}, {0, 0.5}, {0, 1}, 1);

    EXPECT_NEAR(factor(kFloor, kCeiling, {facing_down(0.5, 0, 1, 1, 1 - 1e-9)}), half, 1e-5);
    EXPECT_NEAR(factor(kCeiling, kFloor, {facing_up(0.5, 0, 1, 1, 1e-9)}), half, 1e-5);
}

// What lies on the floor takes its part of the floor out of sight.
TEST(BlockedFactor, OfAFloorHalfCoveredIsThatOfTheOtherHalf) {
    const double half = reference::parallel_rectangles({0, 0.5}, {0, 1}, {0, 1}, {0, 1}, 1) / 2;

    EXPECT_NEAR(factor(kFloor, kCeiling, {facing_down(0.5, 0, 1, 1, 1e-9)}), half, 2e-5);
}

// A wall on the floor up to the ceiling between two halves: each sees its own half.
TEST(BlockedFactor, AcrossAWallThatTouchesBoth) {
    const ConvexPolygon wall = {{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 0, 1}};
    const double own = reference::parallel_rectangles(0.5, 1, 1);

    EXPECT_NEAR(factor(kFloor, kCeiling, sheet(wall), 1e-4), own, 1e-4);
}

TEST(BlockedFactor, CountsOverlappingBlockersOnce) {
    const auto plate = facing_down(0.2, 0.3, 0.7, 0.8, 0.4);
    const Polygons parts = {facing_down(0.2, 0.3, 0.5, 0.8, 0.4),
                            facing_down(0.4, 0.3, 0.7, 0.8, 0.4), plate};

    EXPECT_NEAR(factor(kFloor, kCeiling, parts), factor(kFloor, kCeiling, {plate}), 1e-8);
}

TEST(BlockedFactor, IgnoresRepeatedCornersOfABlocker) {
    const auto plate = facing_down(0.2, 0.3, 0.7, 0.8, 0.4);
    const ConvexPolygon repeated = {plate[0], plate[1], plate[2], plate[2], plate[3]};

    EXPECT_EQ(factor(kFloor, kCeiling, {repeated}), factor(kFloor, kCeiling, {plate}));
}

// The part of a blocker behind the ceiling hides nothing, whatever it looks like from below.
TEST(BlockedFactor, TakesOfABlockerWhatIsInFront) {
    const ConvexPolygon wall = {{0.5, 0, 0.5}, {0.5, 1, 0.5}, {0.5, 1, 3}, {0.5, 0, 3}};
    const ConvexPolygon lower = {{0.5, 0, 0.5}, {0.5, 1, 0.5}, {0.5, 1, 1}, {0.5, 0, 1}};

    EXPECT_NEAR(factor(kFloor, kCeiling, sheet(wall)), factor(kFloor, kCeiling, sheet(lower)),
                1e-10);
}

TEST(BlockedFactor, IsReciprocalPastSheets) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const auto t = random_triple(random, 3, 0.5);
        const double there = factor(t.from, t.to, t.blockers, 1e-5) * test::area_of(t.from);
        const double back = factor(t.to, t.from, t.blockers, 1e-5) * test::area_of(t.to);
        const double larger = std::max(test::area_of(t.from), test::area_of(t.to));
        EXPECT_NEAR(there, back, 3e-5 * larger) << trial;
    }
}

TEST(BlockedFactor, AgreesWithRays) {
    std::mt19937 random(2);
    double squares = 0;
    for (int trial = 0; trial < 60;) {
        const auto t = random_triple(random, 1 + trial % 6, 0.4);
        const double whole = polygon_to_polygon(t.from, t.to);
        if (whole < 0.01) continue;  // few of the rays would count
        ++trial;
        const double difference =
            factor(t.from, t.to, t.blockers, 1e-6) - by_rays(t.from, t.to, t.blockers, 24, random);
        EXPECT_LT(std::abs(difference), 0.02 * whole) << trial;
        squares += std::pow(difference / whole, 2);
    }
    EXPECT_LT(std::sqrt(squares / 60), 0.003);
}

class Bounds : public ::testing::TestWithParam<double> {};

TEST_P(Bounds, HoldForAllButOneInAHundred) {
    std::mt19937 random(3);
    const int trials = 1500;
    int exceeded = 0, above_target = 0;
    for (int trial = 0; trial < trials; ++trial) {
        const auto t = random_triple(random, 1 + trial % 8, trial % 2 == 0 ? 0.5 : 0.15);
        const auto rough = blocked_polygon_to_polygon(t.from, t.to, t.blockers, GetParam());
        const double sharp = factor(t.from, t.to, t.blockers, GetParam() / 30);
        exceeded += std::abs(rough.value - sharp) > rough.error;
        above_target += rough.error > GetParam();
    }
    EXPECT_LT(exceeded, trials / 100);
    EXPECT_EQ(above_target, 0);
}

INSTANTIATE_TEST_SUITE_P(Targets, Bounds, ::testing::Values(1e-2, 1e-3, 1e-4));

}  // namespace
}  // namespace hemirad::blocked_factor_test
