#include "reference/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/reference/shapes.h"

namespace hemirad::reference::closed_forms_test {
namespace {

double point_factor(const glm::dvec3& origin, const glm::dvec3& normal, const Polygon& to) {
    return point_to_polygon(origin, normal, to.corners);
}

// Midpoint rule over the shooter.
double mean_point_factor(const Polygon& from, const Polygon& to, int samples) {
    double sum = 0;
    const auto points = sample_points(from, samples);
    for (const auto& point : points) sum += point_factor(point, normal(from), to);
    return sum / double(points.size());
}

TEST(ParallelRectangles, GivesThePublishedValueOfAUnitCube) {
    EXPECT_NEAR(parallel_rectangles(1, 1, 1), 0.199825, 5e-7);
}

TEST(PerpendicularRectangles, GivesThePublishedValueOfAUnitCube) {
    EXPECT_NEAR(perpendicular_rectangles(1, 1, 1), 0.200044, 5e-7);
}

TEST(ClosedForms, CloseAnyBox) {
    const double a = 1.7, b = 0.6, c = 0.9;  // the floor is a x b, the height c

    const double sum = parallel_rectangles(a, b, c) + 2 * perpendicular_rectangles(a, b, c) +
                       2 * perpendicular_rectangles(b, a, c);

    EXPECT_NEAR(sum, 1, 1e-14);
}

TEST(PerpendicularRectangles, AreReciprocal) {
    EXPECT_NEAR(0.4 * perpendicular_rectangles(1.3, 0.4, 2.1),
                2.1 * perpendicular_rectangles(1.3, 2.1, 0.4), 1e-14);
}

TEST(ParallelRectangles, TendToOneWhenTheyTouch) {
    EXPECT_NEAR(parallel_rectangles(1, 1, 1e-6), 1, 1e-5);
}

TEST(ParallelRectangles, AreTheMeanOfThePointFactor) {
    const Polygon floor = quad({0, 0, 0}, {1.5, 0, 0}, {1.5, 0.8, 0}, {0, 0.8, 0});
    const Polygon above = quad({0, 0, 0.7}, {0, 0.8, 0.7}, {1.5, 0.8, 0.7}, {1.5, 0, 0.7});

    EXPECT_NEAR(mean_point_factor(floor, above, 200), parallel_rectangles(1.5, 0.8, 0.7), 1e-5);
}

TEST(PerpendicularRectangles, AreTheMeanOfThePointFactor) {
    const Polygon floor = quad({0, 0, 0}, {1.5, 0, 0}, {1.5, 0.8, 0}, {0, 0.8, 0});
    const Polygon wall = quad({0, 0, 0}, {0, 0, 0.7}, {1.5, 0, 0.7}, {1.5, 0, 0});

    EXPECT_NEAR(mean_point_factor(floor, wall, 400), perpendicular_rectangles(1.5, 0.8, 0.7), 1e-5);
}

TEST(ParallelRectangles, AtAnyOffsetAreThoseDirectlyOpposed) {
    EXPECT_NEAR(parallel_rectangles({0, 1.5}, {0, 0.8}, {0, 1.5}, {0, 0.8}, 0.7),
                parallel_rectangles(1.5, 0.8, 0.7), 1e-13);
}

TEST(ParallelRectangles, AtAnyOffsetAddUp) {
    const Interval x{0, 1.5}, y{0.2, 0.8};

    const double whole = parallel_rectangles(x, y, {-1, 3}, {0.5, 2}, 0.4);
    const double parts = parallel_rectangles(x, y, {-1, 0.9}, {0.5, 2}, 0.4) +
                         parallel_rectangles(x, y, {0.9, 3}, {0.5, 2}, 0.4);

    EXPECT_NEAR(whole, parts, 1e-13);
}

TEST(ParallelRectangles, AtAnyOffsetAreTheMeanOfThePointFactor) {
    const Polygon floor = quad({0, 0, 0}, {1.5, 0, 0}, {1.5, 0.8, 0}, {0, 0.8, 0});
    const Polygon above = quad({1, 2, 0.7}, {1, 3, 0.7}, {4, 3, 0.7}, {4, 2, 0.7});

    EXPECT_NEAR(parallel_rectangles({0, 1.5}, {0, 0.8}, {1, 4}, {2, 3}, 0.7),
                mean_point_factor(floor, above, 200), 1e-6);
}

TEST(PerpendicularRectangles, AtAnyOffsetAreThoseWithACommonEdge) {
    EXPECT_NEAR(perpendicular_rectangles({0, 1.5}, {0, 0.8}, {0, 1.5}, {0, 0.7}),
                perpendicular_rectangles(1.5, 0.8, 0.7), 1e-13);
}

TEST(PerpendicularRectangles, AtAnyOffsetAreTheMeanOfThePointFactor) {
    const Polygon floor = quad({0, 0.1, 0}, {1.5, 0.1, 0}, {1.5, 0.8, 0}, {0, 0.8, 0});
    const Polygon wall = quad({0.5, 0, 0.2}, {0.5, 0, 0.7}, {2, 0, 0.7}, {2, 0, 0.2});

    EXPECT_NEAR(perpendicular_rectangles({0, 1.5}, {0.1, 0.8}, {0.5, 2}, {0.2, 0.7}),
                mean_point_factor(floor, wall, 300), 1e-6);
}

TEST(ByContours, AgreesWithBothKindsOfRectangles) {
    const Polygon floor = quad({0, 0.1, 0}, {1.5, 0.1, 0}, {1.5, 0.8, 0}, {0, 0.8, 0});
    const Polygon above = quad({1, 2, 0.7}, {1, 3, 0.7}, {4, 3, 0.7}, {4, 2, 0.7});
    const Polygon wall = quad({0.5, 0, 0.2}, {0.5, 0, 0.7}, {2, 0, 0.7}, {2, 0, 0.2});

    EXPECT_NEAR(by_contours(floor.corners, above.corners, 200),
                parallel_rectangles({0, 1.5}, {0.1, 0.8}, {1, 4}, {2, 3}, 0.7), 1e-5);
    EXPECT_NEAR(by_contours(floor.corners, wall.corners, 200),
                perpendicular_rectangles({0, 1.5}, {0.1, 0.8}, {0.5, 2}, {0.2, 0.7}), 1e-5);
}

TEST(ByContours, AgreesWithTheMeanOfThePointFactorInGeneralPosition) {
    const Polygon from = triangle({0, 0, 0}, {1, 0.2, 0.1}, {0.3, 1, -0.2});
    const Polygon to = triangle({0.2, 0.1, 1.5}, {-0.5, 1, 0.9}, {0.8, 0.9, 1.2});

    EXPECT_NEAR(by_contours(from.corners, to.corners, 100), mean_point_factor(from, to, 100), 1e-5);
}

TEST(PointToPolygon, SeesALargeCeilingAsEverything) {
    EXPECT_NEAR(point_factor({0, 0, 0}, {0, 0, 1}, ceiling(1e6, 1)), 1, 1e-9);
}

TEST(PointToPolygon, SeesASquareOverheadAsPublished) {
    // A corner above the point, sides a, b at distance c: configuration factor with X = a/c, Y =
    // b/c 1/(2 pi) (X/sqrt(1+X^2) atan(Y/sqrt(1+X^2)) + Y/sqrt(1+Y^2) atan(X/sqrt(1+Y^2))).
    const double root = std::sqrt(2.0);
    const double quarter = 2 * std::atan(1 / root) / root / (2 * std::numbers::pi);

    EXPECT_NEAR(point_factor({0, 0, 0}, {0, 0, 1}, ceiling(1, 1)), 4 * quarter, 1e-14);
}

TEST(PointToPolygon, SeesAWallInFrontToHalfTheDisk) {
    // An endless wall whose foot is on the horizon covers half of the sky.
    const double far = 1e7;
    const Polygon wall = quad({1, -far, -far}, {1, -far, far}, {1, far, far}, {1, far, -far});

    EXPECT_NEAR(point_factor({0, 0, 0}, {0, 0, 1}, wall), 0.5, 1e-6);
}

TEST(PointToPolygon, ClipsWhatLiesBelowTheHorizon) {
    const Polygon whole = quad({1, -1, -2}, {1, -1, 1}, {1, 1, 1}, {1, 1, -2});
    const Polygon upper = quad({1, -1, 0}, {1, -1, 1}, {1, 1, 1}, {1, 1, 0});

    const double factor = point_factor({0, 0, 0}, {0, 0, 1}, whole);

    EXPECT_GT(factor, 0.05);
    EXPECT_NEAR(factor, point_factor({0, 0, 0}, {0, 0, 1}, upper), 1e-14);
}

TEST(PointToPolygon, SeesNothingOfABackOrBelowTheHorizon) {
    EXPECT_EQ(point_factor({0, 0, 0}, {0, 0, 1}, reversed(ceiling(1, 1))), 0);
    EXPECT_EQ(point_factor({0, 0, 0}, {0, 0, 1}, reversed(ceiling(1, -1))), 0);
}

TEST(PointToPolygon, ClosesARoom) {
    double sum = 0;
    for (const Polygon& wall : room({1, 0.7, 0.4}, 3))
        sum += point_factor(tilted().origin, tilted().normal, wall);

    EXPECT_NEAR(sum, 1, 1e-14);
}

}  // namespace
}  // namespace hemirad::reference::closed_forms_test
