#include <gtest/gtest.h>

#include <cmath>

#include "reference/form_factor_matrix.h"
#include "reference/monte_carlo.h"
#include "reference/ray_caster.h"
#include "tests/reference/views.h"

#ifdef HEMI_EMBREE
#include "reference/embree/embree_caster.h"
#endif

namespace hemirad::reference::baselines_test {
namespace {

/// As the resolution grows.
double slope_of(const std::vector<View>& views, const Method& method) {
    const std::vector<int> resolutions{32, 64, 128, 256, 512};
    std::vector<double> errors;
    for (const int resolution : resolutions) errors.push_back(rms_error(views, method, resolution));
    return slope(resolutions, errors);
}

TEST(SampleShares, MakeTheMeanOfATrapeziumItsCentroid) {
    const Polygon trapezium = quad({-1, 0, 0}, {1, 0, 0}, {.2, 1, 0}, {-.2, 1, 0});
    const auto points = sample_points(trapezium, 32);
    const auto shares = sample_shares(trapezium, 32);

    double sum = 0, height = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        sum += shares[i];
        height += shares[i] * points[i].y;
    }

    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(height, (2 + 2 * 0.4) / (2 + 0.4) / 3, 1e-3);  // half a unit were they even
}

TEST(SampleShares, AreEvenOnTrianglesAndRectangles) {
    for (const Polygon& polygon : {ceiling(0.5, 1), triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0})})
        for (const double share : sample_shares(polygon, 3)) EXPECT_NEAR(share, 1 / 9.0, 1e-12);
}

TEST(Hemisphere, CountsWhatTheOracleCounts) {
    const auto triangles = soup(60, 0.6, 7);
    const Truth truth = project(tilted(), triangles, 96);

    const PointFactors factors = hemisphere_factors(tilted(), triangles, 96);

    const double disk = double(disk_proxel_count(96));
    EXPECT_EQ(factors.sample_count, disk_proxel_count(96));
    for (int index = 0; index < 60; ++index)
        EXPECT_NEAR(factors.values[std::size_t(index)], double(truth.count(index)) / disk, 1e-12);
    EXPECT_NEAR(factors.outside, double(truth.count(kEscaped)) / disk, 1e-12);
}

// A smooth outline cuts N cells, each with an error of N^-2 of either sign: N^(1/2) of them are
// left.
TEST(Hemisphere, ErrorFallsAsThreeHalvesPowerOfResolution) {
    EXPECT_NEAR(slope_of(triangle_views(300, 0.3), by_hemisphere), -1.5, 0.15);
}

TEST(Hemisphere, ErrorFallsAlikeWhereEdgesRunAlongTheAxes) {
    EXPECT_NEAR(slope_of(room_views(10, 4), by_hemisphere), -1.5, 0.2);
}

// A sheet in general position, both sides: from each, rounding puts the other before or behind.
std::vector<Polygon> sheet() {
    const Shooter frame = tilted();
    const auto v_axis = glm::cross(frame.normal, frame.u_axis);
    const Polygon front = quad(frame.origin, frame.origin + frame.u_axis,
                               frame.origin + frame.u_axis + v_axis, frame.origin + v_axis);
    return {front, reversed(front)};
}

TEST(Hemisphere, SeesNothingOfItsOwnSheet) {
    for (const Polygon& side : sheet())
        for (const Shooter& shooter : shooters_on(side, 8)) {
            const auto factors = hemisphere_factors(shooter, sheet(), 32);

            EXPECT_NEAR(factors.outside, 1, 1e-12);
        }
}

TEST(Hemicube, TakesThreeTimesResolutionSquaredSamplesThatAddUpToOne) {
    for (const int resolution : {8, 32, 128}) {
        const PointFactors factors = hemicube_factors(tilted(), {}, resolution);

        EXPECT_EQ(factors.sample_count, std::uint64_t(3 * resolution * resolution));
        // The midpoint rule's remainder is -h^2 / 24 times the weight's outward derivative along
        // the faces' edges, h = 2 / N: 0.542 / N^2 of all five.
        EXPECT_NEAR(resolution * resolution * (factors.outside - 1), 0.542, 0.01);
    }
}

TEST(Hemicube, SeesOneWallThroughEachFace) {
    const View view{upward(), room({1, 1, 1})};

    const PointFactors factors = by_hemicube(view, 256);

    for (std::size_t wall = 0; wall < 6; ++wall)
        EXPECT_NEAR(factors.values[wall], closed_form(view.shooter, view.polygons[wall]), 1e-5);
}

TEST(Hemicube, ErrorFallsAsThreeHalvesPowerOfResolution) {
    EXPECT_NEAR(slope_of(triangle_views(300, 0.3), by_hemicube), -1.5, 0.15);
}

// An edge along a row of pixels takes or leaves the whole row.
TEST(Hemicube, ErrorFallsAsResolutionWhereEdgesRunAlongTheAxes) {
    EXPECT_NEAR(slope_of(room_views(10, 4), by_hemicube), -1, 0.15);
}

TEST(Hemicube, LosesNothingInARoom) {
    const View view{tilted(), room({1, 0.7, 0.4}, 5)};

    EXPECT_EQ(by_hemicube(view, 64).outside, 0);
}

TEST(SinglePlane, LosesWhatPassesBesideIt) {
    for (const double half_width : {0.5, 2.0, 10.0}) {
        const double passes_through = closed_form(upward(), ceiling(half_width, 1));

        const PointFactors factors = single_plane_factors(tilted(), {}, 1024, half_width);

        EXPECT_EQ(factors.sample_count, 1024u * 1024u);
        EXPECT_NEAR(factors.outside, passes_through, 2e-5);
    }
}

TEST(SinglePlane, SeesOnlyWhatIsAboveIt) {
    // Through the plane's edge at x = 2: half a unit of height below, half above.
    const Polygon wall = quad({2, -1, 0.5}, {2, -1, 1.5}, {2, 1, 1.5}, {2, 1, 0.5});
    const Polygon upper = quad({2, -1, 1}, {2, -1, 1.5}, {2, 1, 1.5}, {2, 1, 1});

    const PointFactors factors = single_plane_factors(upward(), {{wall}}, 1024, 2);

    EXPECT_NEAR(factors.values[0], closed_form(upward(), upper), 2e-4);
    EXPECT_LT(factors.values[0], 0.8 * closed_form(upward(), wall));
}

TEST(SinglePlane, ErrorEndsAtTheGrazingEnergy) {
    const auto views = triangle_views(100, 0.3);

    const double at_512 = rms_error(views, by_plane(7), 512);
    const double at_1024 = rms_error(views, by_plane(7), 1024);

    EXPECT_GT(at_1024, 0.7 * at_512);
}

TEST(Hemisphere, BeatsHemicubeAndSinglePlaneAtEqualNumbersOfSamples) {
    constexpr double kSamples = 12288;
    for (const auto& views :
         {triangle_views(500, 0.1), triangle_views(500, 0.3), room_views(10, 4)}) {
        const double error = rms_error(views, by_hemisphere, hemisphere_of(kSamples));

        EXPECT_LT(error, 0.95 * rms_error(views, by_hemicube, hemicube_of(kSamples)));
        EXPECT_LT(error, 0.25 * rms_error(views, by_plane(7), plane_of(kSamples)));
    }
}

TEST(ConstantDistance, AgreesWherePatchesLieApart) {
    const std::vector<Polygon> polygons{ceiling(0.5, 1), ceiling(0.2, 0.5, {0.2, 0.1})};

    const auto true_distance = hemisphere_factors(upward(), polygons, 128);
    const auto constant = hemisphere_factors(upward(), polygons, 128, Distance::of_patch);

    EXPECT_EQ(true_distance.values, constant.values);
}

TEST(ConstantDistance, GivesAllOfASmallPatchToALargeOneWhoseMiddleIsNearer) {
    // The floor of a long ramp passes behind the small patch, its middle before it.
    const Polygon ramp = quad({-3, -1, 0.2}, {-3, 1, 0.2}, {3, 1, 2.2}, {3, -1, 2.2});
    const Polygon small = ceiling(0.1, 1.4, {1.5, 0});
    ASSERT_GT(hemisphere_factors(upward(), {{small}}, 128).values[0], 0);

    const auto true_distance = hemisphere_factors(upward(), {{ramp, small}}, 128);
    const auto constant = hemisphere_factors(upward(), {{ramp, small}}, 128, Distance::of_patch);

    EXPECT_GT(true_distance.values[1], 0);
    EXPECT_EQ(constant.values[1], 0);
    EXPECT_NEAR(constant.values[0], true_distance.values[0] + true_distance.values[1], 1e-12);
}

TEST(RayCaster, FindsTheOwnerOfEveryDecidedProxel) {
    const auto triangles = soup(300, 0.5, 9);
    const RayCaster caster(triangles);
    const Shooter shooter = tilted();
    const Truth truth = project(shooter, triangles, 64, 1e-12);
    const auto v_axis = glm::cross(shooter.normal, shooter.u_axis);
    int owned = 0;
    for (int row = 0; row < 64; ++row)
        for (int column = 0; column < 64; ++column) {
            const std::size_t proxel = std::size_t(row) * 64 + column;
            if (truth.owner[proxel] == kOutsideDisk || !truth.decided(proxel)) continue;
            const double u = (2 * column - 63) / 64.0, v = (2 * row - 63) / 64.0;
            const auto direction =
                u * shooter.u_axis + v * v_axis + std::sqrt(1 - u * u - v * v) * shooter.normal;

            ASSERT_EQ(caster(shooter.origin, direction), truth.owner[proxel]);

            owned += truth.owner[proxel] >= 0;
        }
    EXPECT_GT(owned, 500);
}

TEST(RayCaster, MeetsAWallAlongWhoseBoxTheRayRuns) {
    const RayCaster caster(std::vector<Polygon>{ceiling(1, 1)});

    EXPECT_EQ(caster({-1, 0, 0}, {0, 0, 1}), 0);
    EXPECT_EQ(caster({1, 0, 0}, {0, 0, 1}), 0);
    EXPECT_EQ(caster({1.001, 0, 0}, {0, 0, 1}), kEscaped);
}

template <class Caster>
class MonteCarlo : public testing::Test {};

#ifdef HEMI_EMBREE
using Casters = testing::Types<RayCaster, EmbreeCaster>;
#else
using Casters = testing::Types<RayCaster>;
#endif
TYPED_TEST_SUITE(MonteCarlo, Casters);

constexpr std::uint64_t kRays = 200000;

template <class Caster>
MonteCarloFactors cast(const std::vector<Polygon>& polygons, std::uint64_t rays = kRays) {
    const Caster caster(polygons);
    return monte_carlo_factors(
        polygons[0], polygons.size(),
        [&](const auto& origin, const auto& direction) { return caster(origin, direction); }, rays,
        1);
}

void expect_within_four_errors(const MonteCarloFactors& factors, std::size_t polygon,
                               double expected) {
    EXPECT_NEAR(factors.values[polygon], expected, 4 * factors.standard_errors[polygon]);
    EXPECT_NEAR(factors.standard_errors[polygon],
                std::sqrt(expected * (1 - expected) / double(factors.ray_count)), 1e-4);
}

TYPED_TEST(MonteCarlo, MeetsTheClosedFormsOfABox) {
    std::vector<Polygon> walls = room({0.5, 0.4, 0.3});
    std::swap(walls[0], walls[4]);  // from the floor

    const auto factors = cast<TypeParam>(walls);

    expect_within_four_errors(factors, 5, parallel_rectangles(1, 0.8, 0.6));
    for (const std::size_t wall : {1u, 4u})
        expect_within_four_errors(factors, wall, perpendicular_rectangles(0.8, 1, 0.6));
    for (const std::size_t wall : {2u, 3u})
        expect_within_four_errors(factors, wall, perpendicular_rectangles(1, 0.8, 0.6));
    EXPECT_EQ(factors.values[0], 0);
    EXPECT_EQ(factors.outside, 0);
}

// The mean over the floor of a point's factor to the ceiling, less that to the blocker's shadow.
double past_the_blocker(const Polygon& floor, double half_blocker) {
    double sum = 0;
    const auto points = sample_points(floor, 100);
    for (const auto& p : points) {
        const auto shadow = [&](double side, double at) {
            return std::clamp(at + 2 * (side * half_blocker - at), -0.5, 0.5);
        };
        const double left = shadow(-1, p.x), right = shadow(1, p.x);
        const double front = shadow(-1, p.y), back = shadow(1, p.y);
        const Polygon hidden =
            quad({left, front, 1}, {left, back, 1}, {right, back, 1}, {right, front, 1});
        const Shooter up{p, {0, 0, 1}, {1, 0, 0}};
        sum += closed_form(up, ceiling(0.5, 1)) - closed_form(up, hidden);
    }
    return sum / double(points.size());
}

TYPED_TEST(MonteCarlo, SeesPastABlockerHalfWay) {
    const Polygon floor = quad({-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0});
    const std::vector<Polygon> polygons{floor, ceiling(0.5, 1), ceiling(0.15, 0.5)};

    const auto factors = cast<TypeParam>(polygons);

    const double expected = past_the_blocker(floor, 0.15);
    ASSERT_LT(expected, 0.9 * parallel_rectangles(1, 1, 1));
    expect_within_four_errors(factors, 1, expected);
}

TYPED_TEST(MonteCarlo, PassesThroughBackFaces) {
    const Polygon floor = quad({-.5, -.5, 0}, {.5, -.5, 0}, {.5, .5, 0}, {-.5, .5, 0});
    const std::vector<Polygon> polygons{floor, ceiling(0.5, 1), reversed(ceiling(0.4, 0.5))};

    const auto factors = cast<TypeParam>(polygons);

    expect_within_four_errors(factors, 1, parallel_rectangles(1, 1, 1));
    EXPECT_EQ(factors.values[2], 0);
}

TYPED_TEST(MonteCarlo, SeesNothingOfItsOwnSheet) {
    for (const auto& sides : {sheet(), std::vector<Polygon>{sheet()[1], sheet()[0]}}) {
        EXPECT_EQ(cast<TypeParam>(sides, 1000).outside, 1);
    }
}

TYPED_TEST(MonteCarlo, StartsEvenlyFromTrianglesAndCrookedQuads) {
    // Its two triangles differ in area, 5 to 1.
    const Polygon trapezium = quad({-1, -.5, 0}, {1, -.5, 0}, {.2, .5, 0}, {-.2, .5, 0});
    const Polygon left = triangle(trapezium.corners[0], trapezium.corners[1], trapezium.corners[2]);
    const Polygon right =
        triangle(trapezium.corners[0], trapezium.corners[2], trapezium.corners[3]);
    const Polygon above = ceiling(0.3, 0.4, {0.1, 0.2});
    double flux = 0;
    for (const Polygon& half : {left, right}) {
        double mean = 0;
        for (const auto& p : sample_points(half, 60))
            mean += closed_form({p, {0, 0, 1}, {1, 0, 0}}, above) / 3600;
        flux += area(half) * mean;
        expect_within_four_errors(cast<TypeParam>({half, above}), 1, mean);
    }

    expect_within_four_errors(cast<TypeParam>({trapezium, above}), 1, flux / area(trapezium));
}

#ifdef HEMI_EMBREE
TEST(EmbreeCaster, FindsWhatTheRayCasterFinds) {
    const auto triangles = soup(300, 0.5, 9);
    const RayCaster exact(triangles);
    const EmbreeCaster single(triangles);
    std::mt19937 random(3);
    int differ = 0;
    for (int ray = 0; ray < 20000; ++ray) {
        const auto origin = random_point(random, 1);
        const auto direction = glm::normalize(random_point(random, 1));
        differ += exact(origin, direction) != single(origin, direction);
    }
    EXPECT_LT(differ, 4);
}
#endif

}  // namespace
}  // namespace hemirad::reference::baselines_test
