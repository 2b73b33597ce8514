#include "solver/near_pairs.h"

#include <gtest/gtest.h>

#include "formfactor/polygon_factors.h"
#include "reference/closed_forms.h"
#include "solver/patch_shapes.h"
#include "support/patches.h"

namespace hemirad::test::near_pairs_test {
namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

// A floor, a ceiling at the same size above it, one far away, and one that turns its back.
Mesh floor_and_ceilings() {
    return mesh_of({square({0, 0, 0}, kX, kY, 1), square({0, 0, 1}, kY, kX, 1),
                    square({0, 0, 50}, kY, kX, 1), square({0, 0, -0.8}, kY, kX, 1)});
}

TEST(NearPairs, HoldTheClosedFormBothWays) {
    const auto near = near_pairs(floor_and_ceilings(), 1e-3);

    EXPECT_EQ(near.begin, (std::vector<std::int32_t>{0, 1, 2, 2, 2}));
    EXPECT_EQ(near.patch, (std::vector<std::int32_t>{1, 0}));
    const double expected = reference::parallel_rectangles(1, 1, 1);
    for (const float factor : near.form_factor) EXPECT_NEAR(factor, expected, 1e-7);
}

TEST(NearPairs, ReachFartherForASmallerError) {
    const auto mesh = mesh_of(box({1, 1, 1}, 6));
    std::size_t before = 0;
    for (const double error : {1e-2, 1e-3, 1e-4, 1e-9}) {
        const auto pairs = near_pairs(mesh, error).patch.size();
        EXPECT_GT(pairs, before);
        before = pairs;
    }
    EXPECT_EQ(before, 6u * 36 * 5 * 36);  // all that do not lie in one plane
}

TEST(NearPairs, FindALargeReceiverOfSmallShooters) {
    std::vector<Polygon> polygons = {square({0, 0, 0}, kX, kY, 100)};
    for (int i = 0; i < 20; ++i) polygons.push_back(square({2.0 * i, 0, 0.1}, kY, kX, 0.1));

    const auto near = near_pairs(mesh_of(polygons), 1e-3);

    for (int i = 1; i <= 20; ++i) EXPECT_EQ(near.begin[i + 1] - near.begin[i], 1) << i;
}

// A lamp of a micrometre or so in a hall: over it, it is a point.
TEST(NearPairs, HoldHoweverSmallOneOfTwoIs) {
    for (const double side : {1e-2, 1e-4, 1e-6}) {
        const auto mesh =
            mesh_of({square({0, 0, 0}, kX, kY, 30), square({3, 2, 15}, kY, kX, side)});

        const auto near = near_pairs(mesh, 1e-12);

        ASSERT_EQ(near.begin, (std::vector<std::int32_t>{0, 1, 2}));
        const auto& floor = mesh.patches[0].corners;
        std::vector<glm::dvec3> corners;
        for (const auto corner : floor) corners.push_back(mesh.vertices[corner]);
        const double expected = point_to_polygon({3, 2, 15}, {0, 0, -1}, corners);
        EXPECT_NEAR(near.form_factor[1] / expected, 1, 1e-6) << side;
        EXPECT_NEAR(near.form_factor[0] / expected / side / side * 900, 1, 1e-6) << side;
    }
}

// Two elements above the floor shoot as one, which a third, beside them, does not belong to.
TEST(NearPairs, OfTwoLevelsAreThoseOfShooterAndElement) {
    auto mesh = mesh_of({square({0, 0, 0}, kX, kY, 1), square({-0.5, 0, 1}, kY, kX, 1),
                         square({0.5, 0, 1}, kY, kX, 1), square({1.5, 0, 1}, kY, kX, 1)});
    const auto corner = [&](std::uint32_t patch, int k) { return mesh.patches[patch].corners[k]; };
    mesh.shooters = {{mesh.patches[0].corners, 0, 0, 1},
                     {{corner(1, 0), corner(1, 1), corner(2, 2), corner(2, 3)}, 1, 1, 2},
                     {mesh.patches[3].corners, 3, 3, 1}};

    const auto near = near_pairs(mesh, 1e-4);

    ASSERT_EQ(near.begin, (std::vector<std::int32_t>{0, 3, 4, 5}));
    EXPECT_EQ(near.patch, (std::vector<std::int32_t>{1, 2, 3, 0, 0}));
    EXPECT_FLOAT_EQ(near.form_factor[0], near.form_factor[1]);
    EXPECT_FLOAT_EQ(near.form_factor[3], near.form_factor[0]);  // both halves, of twice the area
    EXPECT_FLOAT_EQ(near.form_factor[4], near.form_factor[2]);
    EXPECT_NEAR(near.form_factor[0] + near.form_factor[1],
                polygon_to_polygon(patch_shapes(mesh)[0].corners, shooter_shapes(mesh)[1].corners),
                1e-7);
}

TEST(ShooterSamples, AreManyOnlyWhereSomethingIsNear) {
    const auto samples = shooter_samples_for(floor_and_ceilings(), 1e-3, 8);

    EXPECT_GE(samples[0], 4);
    EXPECT_EQ(samples[0], samples[1]);
    EXPECT_EQ(samples[2], 1);
    EXPECT_EQ(samples[3], 1);
    for (const auto most : shooter_samples_for(floor_and_ceilings(), 1e-9, 8)) EXPECT_LE(most, 8);
}

}  // namespace
}  // namespace hemirad::test::near_pairs_test
