#include "solver/view_factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formfactor/blocked_factor.h"
#include "formfactor/shapes.h"
#include "reference/closed_forms.h"
#include "scene/scenes_by_hand.h"
#include "support/patches.h"

namespace hemirad::view_factors_test {
namespace {

using test::box;
using test::mesh_of;
using test::Polygon;

FormFactors factors_of(const Mesh& mesh, std::optional<double> target, std::uint32_t samples = 1,
                       std::uint32_t resolution = 128, std::vector<std::uint32_t> from = {}) {
    ViewFactorSettings settings;
    settings.resolution = resolution;
    settings.shooter_samples = samples;
    settings.target_error = target;
    settings.from = std::move(from);
    return view_factors(mesh, settings, mp1map::Device::open(""),
                        [](std::size_t, std::size_t) { return true; });
}

double largest_error(const FormFactors& factors) {
    double largest = 0;
    for (const auto& row : factors.rows)
        for (const FormFactor& factor : row) largest = std::max(largest, double(factor.error));
    return largest;
}

Polygon polygon_of(const ConvexPolygon& corners) {
    return {{corners[0], corners[1], corners[2], corners.back()}};
}

std::vector<Polygon> squares(double distance) {
    return {polygon_of(test::facing_up(0, 0, 1, 1)),
            polygon_of(test::facing_down(0, 0, 1, 1, distance))};
}

// Random sheets that hide one another, backs and all.
Mesh soup(int sheets, double half, unsigned seed) {
    std::mt19937 random(seed);
    Scene scene;
    scene.file = "soup";
    scene.bands = {"Y"};
    scene.objects = {"sheets"};
    scene.materials = {{"paper", {0.5}, {1.0}, false}};
    for (int k = 0; k < sheets; ++k)
        add_face(scene, test::random_triangle(random, test::random_point(random, 0.5), half));
    return build_mesh(scene, {.patch_size = std::numeric_limits<double>::infinity()});
}

std::vector<ConvexPolygon> corners_of(const Mesh& mesh) {
    std::vector<ConvexPolygon> polygons;
    for (const Patch& patch : mesh.patches) {
        auto& polygon = polygons.emplace_back();
        for (int k = 0; k < (patch.is_triangle() ? 3 : 4); ++k)
            polygon.push_back(mesh.vertices[patch.corners[k]]);
    }
    return polygons;
}

using Truth = std::vector<std::vector<Estimate>>;  // [from][to]

// Every patch is a blocker.
Truth truth_of(const Mesh& mesh) {
    const auto polygons = corners_of(mesh);
    Truth truth(polygons.size());
    for (std::size_t from = 0; from < polygons.size(); ++from)
        for (const auto& to : polygons)
            truth[from].push_back(
                blocked_polygon_to_polygon(polygons[from], to, polygons, 1e-5, 5000));
    return truth;
}

struct Honesty {
    int pairs = 0, beyond_own = 0, beyond_target = 0;
};

// Of all pairs that may see each other.
Honesty honesty(const Truth& truth, const FormFactors& factors, double target) {
    Honesty result;
    for (std::size_t row = 0; row < factors.rows.size(); ++row)
        for (std::uint32_t to = 0; to < truth.size(); ++to) {
            const Estimate& exact = truth[factors.from[row]][to];
            if (exact.value == 0) continue;
            const auto& list = factors.rows[row];
            const auto found = std::ranges::lower_bound(list, to, {}, &FormFactor::to);
            const bool known = found != list.end() && found->to == to;
            const double off = std::abs((known ? found->value : 0) - exact.value) - exact.error;
            ++result.pairs;
            if (known) result.beyond_own += off > found->error;
            result.beyond_target += off > target;
        }
    return result;
}

class Targets : public ::testing::TestWithParam<double> {};

TEST_P(Targets, AreMetInAUnitCube) {
    const auto factors = factors_of(mesh_of(box({0.5, 0.5, 0.5}, 1)), GetParam());

    for (std::size_t i = 0; i < 6; ++i)
        for (std::uint32_t j = 0; j < 6; ++j) {
            const double exact = i == j           ? 0
                                 : i / 2 == j / 2 ? reference::parallel_rectangles(1, 1, 1)
                                                  : reference::perpendicular_rectangles(1, 1, 1);
            EXPECT_NEAR(factors.at(i, j), exact, GetParam()) << i << " " << j;
        }
    EXPECT_LE(closure_error(factors), 1e-12);
    EXPECT_LE(largest_error(factors), GetParam());
}

TEST_P(Targets, AreMetBetweenSquaresAtAnyDistance) {
    for (const double distance : {0.01, 0.1, 1.0, 10.0, 100.0}) {
        const auto factors = factors_of(mesh_of(squares(distance)), GetParam());
        const double exact = reference::parallel_rectangles(1, 1, distance);

        EXPECT_NEAR(factors.at(0, 1), exact, GetParam()) << distance;
        EXPECT_NEAR(factors.at(1, 0), exact, GetParam()) << distance;
        EXPECT_NEAR(factors.outside[0], 1 - exact, GetParam()) << distance;
        EXPECT_LE(closure_error(factors), 1e-12);
    }
}

TEST_P(Targets, AreMetPastAPlate) {
    auto polygons = squares(1);
    const auto plate = test::facing_down(0.2, 0.3, 0.9, 0.8, 0.6);
    for (const auto& side : {plate, test::reversed(plate)}) polygons.push_back(polygon_of(side));
    const Mesh mesh = mesh_of(polygons);

    const auto factors = factors_of(mesh, GetParam());

    const auto found = honesty(truth_of(mesh), factors, GetParam());
    EXPECT_EQ(found.beyond_target, 0);
    EXPECT_GT(factors.at(0, 1), 0.01);
    EXPECT_NEAR(factors.at(0, 1), factors.at(1, 0), 2 * GetParam());
}

TEST_P(Targets, AreMetAmongSheetsThatHideOneAnother) {
    const Mesh mesh = soup(40, 0.2, 7);

    const auto factors = factors_of(mesh, GetParam(), 2, 256);
    const auto found = honesty(truth_of(mesh), factors, GetParam());

    EXPECT_LE(largest_error(factors), GetParam() * 1.000001);
    EXPECT_LT(found.beyond_own, 0.01 * found.pairs);
    EXPECT_LT(found.beyond_target, 0.01 * found.pairs);
    EXPECT_LE(closure_error(factors), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Errors, Targets, ::testing::Values(1e-3, 1e-4));

TEST(ViewFactors, ByCountingAloneCloseAndKnowTheirError) {
    const Mesh mesh = soup(40, 0.2, 8);
    const Truth truth = truth_of(mesh);

    for (const std::uint32_t samples : {0u, 1u, 2u, 4u}) {
        const auto factors = factors_of(mesh, {}, samples, 256);
        const auto found = honesty(truth, factors, 1);

        EXPECT_LE(closure_error(factors), 1e-12);
        EXPECT_LT(found.beyond_own, 0.01 * found.pairs) << samples;
    }
}

// A crate on a floor: what touches sees nothing but each other, and the floor beneath does not look
// out through the crate.
TEST(ViewFactors, OfWhatStandsOnAFloorCloseTheRoom) {
    auto polygons = box({1, 1, 1}, 1);
    const glm::dvec3 corner[] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
    const auto raised = [&](int k) { return corner[k % 4] + glm::dvec3(0, 0, -0.5); };
    const auto low = [&](int k) { return corner[k % 4] + glm::dvec3(0, 0, -1); };
    polygons.push_back({{low(3), low(2), low(1), low(0)}});
    polygons.push_back({{raised(0), raised(1), raised(2), raised(3)}});
    for (int k = 0; k < 4; ++k)
        polygons.push_back({{low(k), low(k + 1), raised(k + 1), raised(k)}});
    Mesh mesh = mesh_of(polygons);
    for (std::uint32_t i = 6; i < 12; ++i) mesh.surfaces[i].object = 1;
    mesh.objects.push_back("crate");
    mesh.parts.resize(2);
    for (auto& part : mesh.parts) part.closed = true;

    const auto factors = factors_of(mesh, 1e-4);

    std::uint32_t floor = 0;
    while (factors.at(6, floor) < 0.5) ++floor;
    EXPECT_EQ(factors.at(6, floor), 1);
    EXPECT_NEAR(factors.at(floor, 6), 0.25, 1e-12);
    EXPECT_LT(reciprocity_error(factors), 2e-4);
    for (const double outside : factors.outside) EXPECT_NEAR(outside, 0, 1e-3);
}

TEST(ViewFactors, BehindAWallAreZero) {
    auto polygons = squares(1);
    const auto wall = test::facing_down(-1, -1, 2, 2, 0.5);
    for (const auto& side : {wall, test::reversed(wall)}) polygons.push_back(polygon_of(side));

    const auto factors = factors_of(mesh_of(polygons), 1e-4);

    EXPECT_EQ(factors.at(0, 1), 0);
    EXPECT_EQ(factors.at(1, 0), 0);
    EXPECT_GT(factors.at(0, 2), 0.5);
}

// Without backs, what hides one way may be clear the other way.
TEST(ViewFactors, PastAnOpenPlateDependOnTheDirection) {
    auto polygons = squares(1);
    polygons.push_back(polygon_of(test::facing_down(-1, -1, 2, 2, 0.5)));

    const auto factors = factors_of(mesh_of(polygons), 1e-4);

    EXPECT_EQ(factors.at(0, 1), 0);
    EXPECT_NEAR(factors.at(1, 0), reference::parallel_rectangles(1, 1, 1), 1e-4);
}

TEST(ViewFactors, OfSheetsWithBacksAreReciprocalWhereIntegrated) {
    const Mesh mesh = soup(12, 0.4, 9);

    const auto factors = factors_of(mesh, 1e-5, 1, 64);

    EXPECT_LT(reciprocity_error(factors), 1e-5);
}

TEST(ViewFactors, OfSomeRowsAreThoseOfAll) {
    const Mesh mesh = soup(30, 0.2, 10);

    const auto all = factors_of(mesh, 1e-4, 2);
    const auto some = factors_of(mesh, 1e-4, 2, 128, {5, 17});

    ASSERT_EQ(some.from, (std::vector<std::uint32_t>{5, 17}));
    ASSERT_EQ(some.area.size(), mesh.patches.size());
    for (std::uint32_t to = 0; to < mesh.patches.size(); ++to) {
        EXPECT_NEAR(some.at(0, to), all.at(5, to), 2e-4);
        EXPECT_NEAR(some.at(1, to), all.at(17, to), 2e-4);
    }
    EXPECT_LE(closure_error(some), 1e-12);
}

TEST(ViewFactors, StopWhenTold) {
    ViewFactorSettings settings;
    settings.resolution = 64;
    std::size_t calls = 0;

    const auto factors =
        view_factors(mesh_of(box({0.5, 0.5, 0.5}, 2)), settings, mp1map::Device::open(""),
                     [&](std::size_t done, std::size_t all) {
                         EXPECT_EQ(done, ++calls);
                         EXPECT_EQ(all, 24u);
                         return done < 3;
                     });

    EXPECT_EQ(factors.rows.size(), 3u);
    EXPECT_EQ(factors.from.size(), 3u);
    EXPECT_EQ(calls, 3u);
}

}  // namespace
}  // namespace hemirad::view_factors_test
