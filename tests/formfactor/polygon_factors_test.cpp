#include "formfactor/polygon_factors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formfactor/shapes.h"
#include "reference/closed_forms.h"

namespace hemirad::polygon_factors_test {
namespace {

using test::area_of;
using test::facing_down;
using test::facing_up;
using test::facing_y;
using test::normal_of;
using test::random_point;
using test::random_triangle;

using Polygons = std::vector<ConvexPolygon>;

// By the midpoint rule over the congruent parts of a triangle.
double mean_over(const ConvexPolygon& triangle, const ConvexPolygon& to, int samples) {
    const glm::dvec3 normal = normal_of(triangle);
    const glm::dvec3 s = (triangle[1] - triangle[0]) / double(samples);
    const glm::dvec3 t = (triangle[2] - triangle[0]) / double(samples);
    double sum = 0;
    for (int row = 0; row < samples; ++row)
        for (int column = 0; column + row < samples; ++column) {
            const auto at = [&](double third) {
                return triangle[0] + (column + third) * s + (row + third) * t;
            };
            sum += point_to_polygon(at(1 / 3.0), normal, to);
            if (column + row + 1 < samples) sum += point_to_polygon(at(2 / 3.0), normal, to);
        }
    return sum / (double(samples) * samples);
}

double mean_factor(const ConvexPolygon& from, const ConvexPolygon& to, int samples) {
    double sum = 0;
    for (std::size_t k = 1; k + 1 < from.size(); ++k) {
        const ConvexPolygon part = {from[0], from[k], from[k + 1]};
        sum += area_of(part) * mean_over(part, to, samples);
    }
    return sum / area_of(from);
}

double exchange_difference(const ConvexPolygon& a, const ConvexPolygon& b) {
    return std::abs(area_of(a) * polygon_to_polygon(a, b) - area_of(b) * polygon_to_polygon(b, a)) /
           std::min(area_of(a), area_of(b));
}

// Largest distance from 1 of the sum of a row.
double closure_error(const Polygons& solid) {
    double largest = 0;
    for (const auto& from : solid) {
        double sum = 0;
        for (const auto& to : solid) sum += polygon_to_polygon(from, to);
        largest = std::max(largest, std::abs(sum - 1));
    }
    return largest;
}

// The inside of the parallelepiped that three vectors span.
Polygons inside_of(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c) {
    Polygons faces;
    const auto add = [&](const glm::dvec3& s, const glm::dvec3& t, const glm::dvec3& across) {
        const glm::dvec3 far = corner + across;
        faces.push_back({corner, corner + s, corner + s + t, corner + t});
        faces.push_back({far, far + t, far + s + t, far + s});
    };
    const bool right_handed = glm::dot(glm::cross(a, b), c) > 0;
    add(a, right_handed ? b : c, right_handed ? c : b);
    add(right_handed ? b : c, right_handed ? c : b, a);
    add(right_handed ? c : b, a, right_handed ? b : c);
    return faces;
}

Polygons inside_of_tetrahedron(const ConvexPolygon& base, const glm::dvec3& top) {
    const ConvexPolygon up =
        glm::dot(normal_of(base), top - base[0]) > 0 ? base : test::reversed(base);
    return {up, {up[1], up[0], top}, {up[2], up[1], top}, {up[0], up[2], top}};
}

TEST(PointToPolygon, AgreesWithTheReferenceAcrossTheHorizonToo) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 1000; ++trial) {
        const glm::dvec3 normal = glm::normalize(random_point(random, 1));
        const auto to = random_triangle(random, random_point(random, 1), 0.7);
        EXPECT_NEAR(point_to_polygon({0, 0, 0}, normal, to),
                    reference::point_to_polygon({0, 0, 0}, normal, to), 1e-13);
    }
}

class SquaresAtADistance : public ::testing::TestWithParam<double> {};

TEST_P(SquaresAtADistance, AreExact) {
    const auto floor = facing_up(0, 0, 1, 1);
    const auto above = facing_down(0, 0, 1, 1, GetParam());

    EXPECT_NEAR(polygon_to_polygon(floor, above), reference::parallel_rectangles(1, 1, GetParam()),
                1e-10);
}

TEST_P(SquaresAtADistance, AreExactWithAnOffsetAndWithoutScale) {
    const double distance = GetParam();
    const auto floor = facing_up(0, 0, 1, 1);
    const auto above = facing_down(0.3, -0.8, 1.7, 0.4, distance);
    const auto scaled = [](ConvexPolygon polygon) {
        for (auto& corner : polygon) corner *= 1e-6;
        return polygon;
    };

    const double exact =
        reference::parallel_rectangles({0, 1}, {0, 1}, {0.3, 1.7}, {-0.8, 0.4}, distance);

    EXPECT_NEAR(polygon_to_polygon(floor, above), exact, 1e-10);
    EXPECT_NEAR(polygon_to_polygon(scaled(floor), scaled(above)), exact, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Distances, SquaresAtADistance,
                         ::testing::Values(0.001, 0.01, 0.1, 1.0, 10.0, 15.0, 17.0, 100.0));

TEST(PolygonToPolygon, IsExactFarAway) {
    const double distance = 1e5;

    const double factor =
        polygon_to_polygon(facing_up(0, 0, 1, 1), facing_down(0, 0, 1, 1, distance));

    EXPECT_NEAR(factor * M_PI * distance * distance, 1, 1e-9);
}

TEST(PolygonToPolygon, IsExactAcrossACommonEdge) {
    EXPECT_NEAR(polygon_to_polygon(facing_up(0, 0, 1.5, 0.8), facing_y(0, 0, 1.5, 0.7)),
                reference::perpendicular_rectangles(1.5, 0.8, 0.7), 1e-12);
}

TEST(PolygonToPolygon, IsExactAcrossAPartOfAnEdgeAndBeyond) {
    EXPECT_NEAR(polygon_to_polygon(facing_up(0, 0, 1.5, 0.8), facing_y(0.4, 0, 2, 0.7)),
                reference::perpendicular_rectangles({0, 1.5}, {0, 0.8}, {0.4, 2}, {0, 0.7}), 1e-12);
    EXPECT_NEAR(polygon_to_polygon(facing_up(0, 0, 1, 1), facing_y(1, 0, 2, 0.7)),
                reference::perpendicular_rectangles({0, 1}, {0, 1}, {1, 2}, {0, 0.7}), 1e-12);
}

TEST(PolygonToPolygon, IsExactAtARightAngleWithoutACommonEdge) {
    EXPECT_NEAR(polygon_to_polygon(facing_up(0, 0.1, 1.5, 0.8), facing_y(0.4, 0.001, 2, 0.7)),
                reference::perpendicular_rectangles({0, 1.5}, {0.1, 0.8}, {0.4, 2}, {0.001, 0.7}),
                1e-11);
}

TEST(PolygonToPolygon, ClosesTheUnitCube) {
    const auto cube = inside_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});

    EXPECT_NEAR(polygon_to_polygon(cube[0], cube[1]), 0.199825, 5e-7);
    EXPECT_NEAR(polygon_to_polygon(cube[0], cube[2]), 0.200044, 5e-7);
    EXPECT_LT(closure_error(cube), 1e-12);
}

class RectanglesAtATilt : public ::testing::TestWithParam<double> {};

TEST_P(RectanglesAtATilt, AcrossACommonEdgeAreTheMeanOfThePointFactor) {
    const double angle = GetParam() * M_PI / 180;
    const glm::dvec3 up(0, std::cos(angle), std::sin(angle));
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0);
    const auto floor = facing_up(0, 0, 1, 1);
    const ConvexPolygon wall = {b, a, a + 0.7 * up, b + 0.7 * up};

    const double coarse = mean_factor(floor, wall, 300), fine = mean_factor(floor, wall, 600);

    EXPECT_NEAR(polygon_to_polygon(floor, wall), fine + (fine - coarse), 3e-5);
}

// Two wedges that share a face and the edge.
TEST_P(RectanglesAtATilt, AddUp) {
    const double angle = GetParam() * M_PI / 180;
    const glm::dvec3 up(0, std::cos(angle), std::sin(angle));
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0.37, 0, 0);
    const auto floor = facing_up(0, 0, 1, 1);

    const double whole = polygon_to_polygon(floor, ConvexPolygon{b, a, a + up, b + up});
    const double parts = polygon_to_polygon(floor, ConvexPolygon{c, a, a + up, c + up}) +
                         polygon_to_polygon(floor, ConvexPolygon{b, c, c + up, b + up});

    EXPECT_NEAR(whole, parts, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(Degrees, RectanglesAtATilt,
                         ::testing::Values(1.0, 10.0, 45.0, 89.0, 120.0, 179.0));

TEST(PolygonToPolygon, ClipsWhatIsBehindEitherPlane) {
    const auto floor = facing_up(0, -1, 1, 1);  // half of it behind the wall
    const auto wall = facing_y(0, -3, 1, 0.7);  // most of it below the floor
    const double exact = reference::perpendicular_rectangles(1, 1, 0.7);

    EXPECT_NEAR(polygon_to_polygon(floor, wall), exact / 2, 1e-12);
    EXPECT_NEAR(polygon_to_polygon(wall, floor), exact / 3.7, 1e-12);
}

TEST(PolygonToPolygon, IsNothingBetweenBacksAndInOnePlane) {
    const auto floor = facing_up(0, 0, 1, 1);

    EXPECT_EQ(polygon_to_polygon(floor, facing_up(0, 0, 1, 1, 1)), 0);
    EXPECT_EQ(polygon_to_polygon(floor, facing_down(0, 0, 1, 1, -1)), 0);
    EXPECT_EQ(polygon_to_polygon(floor, facing_up(1, 0, 2, 1)), 0);
    EXPECT_EQ(polygon_to_polygon(floor, test::reversed(floor)), 0);
    EXPECT_EQ(polygon_to_polygon(floor, floor), 0);
}

TEST(PolygonToPolygon, IsNothingWithoutAnArea) {
    const auto floor = facing_up(0, 0, 1, 1);
    const ConvexPolygon line = {{0, 0, 1}, {0.5, 0.5, 1}, {1, 1, 1}}, point(3, {0, 0, 1});

    for (const auto& flat : {line, point, ConvexPolygon{}}) {
        EXPECT_EQ(polygon_to_polygon(floor, flat), 0);
        EXPECT_EQ(polygon_to_polygon(flat, floor), 0);
    }
}

TEST(PolygonToPolygon, IgnoresRepeatedAndStraightCorners) {
    ConvexPolygon floor = facing_up(0, 0, 1, 1);
    const auto above = facing_down(0, 0, 1, 1, 0.5);
    const double factor = polygon_to_polygon(floor, above);
    floor.insert(floor.begin() + 1, {{0, 0, 0}, {0.3, 0, 0}});

    EXPECT_NEAR(polygon_to_polygon(floor, above), factor, 1e-14);
    EXPECT_NEAR(polygon_to_polygon(above, floor), factor, 1e-14);
}

TEST(PolygonToPolygon, IsExactForSlivers) {
    for (const double width : {1e-2, 1e-4, 1e-6}) {
        const ConvexPolygon sliver = {
            {0, 0.2, 0}, {1, 0.2, 0}, {1, 0.2 + width, 0}, {0, 0.2 + width, 0}};
        EXPECT_NEAR(
            polygon_to_polygon(sliver, facing_y(0.3, 0, 1.4, 0.7)),
            reference::perpendicular_rectangles({0, 1}, {0.2, 0.2 + width}, {0.3, 1.4}, {0, 0.7}),
            1e-9 + 1e-16 / width);
        const auto wall = facing_y(0.3, 0, 1.4, 0.7);
        const ConvexPolygon triangle = {{0, 0.2, 0}, {1, 0.3, 0}, {1, 0.3 + width, 0}};
        EXPECT_NEAR(polygon_to_polygon(triangle, wall), mean_factor(triangle, wall, 200), 1e-5);
    }
}

// Edges that nearly meet, at any angle, against the reference of another kind.
TEST(PolygonToPolygon, IsExactForEdgesThatNearlyMeet) {
    std::mt19937 random(5);
    for (int trial = 0; trial < 20; ++trial) {
        const glm::dvec3 gap(0, 0, std::pow(10.0, -1 - 0.4 * trial));
        const auto from = random_triangle(random, {0, 0, 0}, 1);
        ConvexPolygon to = random_triangle(random, {0, 0, 0}, 1);
        to[0] = 0.4 * from[0] + 0.6 * from[1] + gap;
        EXPECT_NEAR(polygon_to_polygon(from, to), mean_factor(from, to, 200), 3e-4) << trial;
        EXPECT_LT(exchange_difference(from, to), 1e-9) << trial;
    }
}

// The factor to a polygon is the sum of those to its parts, whatever edges that makes.
double splitting_error(const ConvexPolygon& from, const ConvexPolygon& to, double at) {
    const glm::dvec3 cut = to[0] + at * (to[1] - to[0]);
    const double parts = polygon_to_polygon(from, ConvexPolygon{to[0], cut, to[2]}) +
                         polygon_to_polygon(from, ConvexPolygon{cut, to[1], to[2]});
    return std::abs(polygon_to_polygon(from, to) - parts);
}

TEST(PolygonToPolygon, AddsUpForEdgesThatPassEachOtherClosely) {
    const auto floor = facing_up(-1, -1, 1, 1);
    for (const double gap : {1e-1, 1e-2, 1e-4, 1e-6}) {
        const glm::dvec3 near(1 - gap, 0.1, gap);  // above the floor's edge, which it crosses
        const ConvexPolygon to = {near - glm::dvec3(0.5, 0.3, -0.1),
                                  near + glm::dvec3(0.5, 0.3, -0.1 * gap),
                                  {0.3, 0.9, 1}};
        EXPECT_GT(polygon_to_polygon(floor, to) + polygon_to_polygon(floor, test::reversed(to)),
                  0.01);
        for (const auto& side : {to, test::reversed(to)})
            EXPECT_LT(splitting_error(floor, side, 0.37), 1e-9) << gap;
    }
}

TEST(PolygonToPolygon, AddsUpForSlivers) {
    std::mt19937 random(8);
    for (int trial = 0; trial < 300; ++trial) {
        auto sliver = random_triangle(random, {0, 0, 0}, 1);
        sliver[2] = 0.5 * (sliver[0] + sliver[1]) + 1e-5 * random_point(random, 1);
        const auto to = random_triangle(random, {0, 0, 0.5}, 1);
        EXPECT_LT(splitting_error(sliver, to, 0.5), 2e-9) << trial;
    }
}

TEST(PolygonToPolygon, IsExactFarAwayInGeneralPosition) {
    std::mt19937 random(9);
    int compared = 0;
    while (compared < 30) {
        const auto from = random_triangle(random, {0, 0, 0}, 1);
        const auto to = random_triangle(random, {10, 20, 30}, 1);
        const double factor = polygon_to_polygon(from, to);
        if (factor < 1e-6) continue;
        EXPECT_NEAR(mean_factor(from, to, 64) / factor, 1, 1e-6);
        ++compared;
    }
}

TEST(PolygonToPolygon, AgreesWithContoursInGeneralPosition) {
    std::mt19937 random(2);
    int compared = 0;
    while (compared < 30) {
        const auto from = random_triangle(random, {0, 0, 0}, 0.5);
        const auto to = random_triangle(random, {0, 0, 2}, 0.5);
        const double all = polygon_to_polygon(from, to);
        if (all == 0 || normal_of(from).z < 0.7 || normal_of(to).z > -0.7) continue;
        EXPECT_NEAR(all, reference::by_contours(from, to, 100), 1e-6);
        ++compared;
    }
}

TEST(PolygonToPolygon, IsReciprocal) {
    std::mt19937 random(3);
    for (int trial = 0; trial < 3000; ++trial) {
        const double distance = std::pow(10.0, trial % 3);
        const auto a = random_triangle(random, {0, 0, 0}, 1);
        const auto b = random_triangle(random, {0.3 * distance, 0, distance}, 1);
        EXPECT_LT(exchange_difference(a, b), 1e-10) << trial;
    }
}

TEST(PolygonToPolygon, ClosesRandomBoxes) {
    std::mt19937 random(4);
    for (int trial = 0; trial < 200; ++trial) {
        const auto box = inside_of(random_point(random, 1), random_point(random, 1),
                                   random_point(random, 1), random_point(random, 1));
        EXPECT_LT(closure_error(box), 1e-9) << trial;
    }
}

TEST(PolygonToPolygon, ClosesRandomTetrahedra) {
    std::mt19937 random(6);
    for (int trial = 0; trial < 300; ++trial) {
        const auto solid =
            inside_of_tetrahedron(random_triangle(random, {0, 0, 0}, 1), random_point(random, 1));
        EXPECT_LT(closure_error(solid), 1e-9) << trial;
    }
}

}  // namespace
}  // namespace hemirad::polygon_factors_test
