#include "reference/form_factor_matrix.h"

#include <gtest/gtest.h>

#include "reference/closed_forms.h"
#include "tests/reference/shapes.h"

namespace hemirad::reference::form_factor_matrix_test {
namespace {

TEST(SamplePoints, AreTheCentresOfAQuadsCells) {
    const Polygon square = quad({0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0});

    const auto points = sample_points(square, 2);

    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[0], glm::dvec3(0.5, 0.5, 0));
    EXPECT_EQ(points[1], glm::dvec3(1.5, 0.5, 0));
    EXPECT_EQ(points[2], glm::dvec3(0.5, 1.5, 0));
    EXPECT_EQ(points[3], glm::dvec3(1.5, 1.5, 0));
}

TEST(SamplePoints, AverageToATrianglesCentroid) {
    const Polygon half = triangle({0, 0, 0}, {3, 0, 0}, {0, 3, 6});
    for (const int samples : {1, 2, 3, 7}) {
        glm::dvec3 sum(0);
        const auto points = sample_points(half, samples);
        for (const auto& point : points) sum += point;

        EXPECT_EQ(points.size(), std::size_t(samples) * samples);
        EXPECT_NEAR(glm::distance(sum / double(points.size()), {1, 1, 2}), 0, 1e-14);
    }
}

TEST(SamplePoints, OfTwoByTwoOnATriangleIncludeItsCentroid) {
    const auto points = sample_points(triangle({0, 0, 0}, {6, 0, 0}, {0, 6, 0}), 2);

    ASSERT_EQ(points.size(), 4u);
    EXPECT_NEAR(glm::distance(points[0], {1, 1, 0}), 0, 1e-14);
    EXPECT_NEAR(glm::distance(points[1], {2, 2, 0}), 0, 1e-14);
}

TEST(PolygonArea, IsThatOfTheTriangleAndOfTheQuad) {
    EXPECT_DOUBLE_EQ(area(triangle({0, 0, 0}, {2, 0, 0}, {0, 3, 0})), 3);
    EXPECT_DOUBLE_EQ(area(quad({0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0})), 6);
}

TEST(FormFactorMatrix, RowsOfARoomSumToOne) {
    const auto walls = room({1, 0.7, 0.4}, 2);

    const auto matrix = form_factor_matrix(walls, 64, 2);

    for (std::size_t from = 0; from < walls.size(); ++from) {
        EXPECT_NEAR(matrix.row_sum(from), 1, 1e-14);
        EXPECT_EQ(matrix.at(from, from), 0);
    }
}

TEST(FormFactorMatrix, SeesNoNeighbourInItsOwnPlane) {
    const auto matrix = form_factor_matrix(room({1, 1, 1}, 2), 128);

    for (std::size_t from = 0; from < 24; ++from)
        for (std::size_t to = from / 4 * 4; to < from / 4 * 4 + 4; ++to)
            EXPECT_EQ(matrix.at(from, to), 0);
}

TEST(FormFactorMatrix, TendsToTheClosedFormsOfACubeWithMoreHemispheres) {
    const auto cube = room({0.5, 0.5, 0.5});
    double previous = 1;
    for (const int samples : {1, 2, 4}) {
        const auto matrix = form_factor_matrix(cube, 512, samples);

        const double opposite = std::abs(matrix.at(0, 1) - parallel_rectangles(1, 1, 1));
        EXPECT_LT(opposite, previous / 3);
        EXPECT_NEAR(matrix.at(0, 2), perpendicular_rectangles(1, 1, 1), opposite);
        previous = opposite;
    }
    EXPECT_LT(previous, 0.011 * parallel_rectangles(1, 1, 1));
}

TEST(FormFactorMatrix, IsReciprocalToWithinItsSampling) {
    const auto walls = room({1, 0.7, 0.4});

    const auto matrix = form_factor_matrix(walls, 256, 8);

    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < 6; ++j)
            EXPECT_NEAR(area(walls[i]) * matrix.at(i, j), area(walls[j]) * matrix.at(j, i), 0.01);
}

TEST(FormFactorMatrix, TakesHemispheresThatTheCallerPlaces) {
    const std::vector<Polygon> pair = {reversed(ceiling(1, 0)), ceiling(1, 1)};
    const std::vector<std::vector<Shooter>> shooters = {{upward()}, shooters_on(pair[1], 1)};

    const auto matrix = form_factor_matrix(pair, shooters, 256);

    EXPECT_NEAR(matrix.at(0, 1), point_to_polygon({0, 0, 0}, {0, 0, 1}, pair[1].corners), 1e-3);
    EXPECT_NEAR(matrix.at(0, 1), matrix.at(1, 0), 1e-3);
}

}  // namespace
}  // namespace hemirad::reference::form_factor_matrix_test
