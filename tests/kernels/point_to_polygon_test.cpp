#include <gtest/gtest.h>

#include <random>

#include "reference/closed_forms.h"
#include "support/patch_database.h"
#include "support/probe.h"

namespace hemirad::test::point_to_polygon_test {
namespace {

constexpr std::size_t kPatches = 20000;  // an even share for sixteen lanes

using Corners = std::vector<Float3>;

// Wholly above, across and below the horizon, large and near, small and far, fronts and backs.
std::vector<Corners> random_patches_anywhere(int corner_count) {
    std::mt19937 random(120);
    std::uniform_real_distribution<double> across(-1, 1), exponent(-3, 0.3);
    std::vector<Corners> patches;
    while (patches.size() < kPatches) {
        const glm::dvec3 centre(across(random), across(random), across(random));
        const double size = std::pow(10, exponent(random));
        const auto polygon = random_polygon(random, centre, size, corner_count);
        Corners corners;
        for (int k = 0; k < corner_count; ++k) corners.push_back(rounded(polygon.corners[k]));
        patches.push_back(corners);
    }
    return patches;
}

std::vector<float> factors_of(const std::vector<Corners>& patches, std::uint32_t lanes) {
    std::vector<float> corners;
    for (std::size_t k = 0; k < patches.front().size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const auto& patch : patches) corners.push_back(patch[k][axis]);
    auto run =
        KernelRun::probe("point_to_polygon", "point_factors",
                         probe_options(lanes, static_cast<std::uint32_t>(patches.front().size())));
    auto factors = run.acu().plural<float>(patches.size());
    run.issue(probe_grid(patches.size(), lanes), run.plural(corners), std::int32_t(patches.size()),
              factors);
    return run.acu().unload(factors);
}

class PointToPolygonKernel : public testing::TestWithParam<int> {};  // corners

INSTANTIATE_TEST_SUITE_P(Corners, PointToPolygonKernel, testing::Values(3, 4));

TEST_P(PointToPolygonKernel, IsLambertsClosedForm) {
    const auto patches = random_patches_anywhere(GetParam());

    const auto factors = factors_of(patches, 16);

    std::size_t seen = 0;
    for (std::size_t i = 0; i < patches.size(); ++i) {
        std::vector<glm::dvec3> corners;
        for (const auto& corner : patches[i]) corners.push_back(exact(corner));
        const double expected = reference::point_to_polygon({0, 0, 0}, {0, 0, 1}, corners);
        // A dozen roundings of edges' factors of at most 1/2 each.
        if (expected > 0) {
            ASSERT_NEAR(factors[i], expected, 12 * 0x1p-25) << "patch " << i;
        }
        seen += expected > 1e-4;
    }
    EXPECT_GT(seen, kPatches / 10);
}

TEST_P(PointToPolygonKernel, DoesNotDependOnTheLanes) {
    const auto patches = random_patches_anywhere(GetParam());
    const auto wide = factors_of(patches, 16);

    for (const std::uint32_t lanes : {1u, 4u, 8u})
        EXPECT_EQ(bits(factors_of(patches, lanes)), bits(wide)) << lanes << " lanes";
}

TEST(AngleOverSine, IsTheArcTangentOverItsSine) {
    std::vector<float> y, x;
    for (int i = 0; i < 16000; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / 16000;
        y.push_back(static_cast<float>(std::sin(angle)));
        x.push_back(static_cast<float>(std::cos(angle)));
    }
    auto run = KernelRun::probe("point_to_polygon", "angles", probe_options(16));
    auto result = run.acu().plural<float>(y.size());
    run.issue(probe_grid(y.size(), 16), run.plural(y), run.plural(x), result);
    const auto angles = run.acu().unload(result);

    for (std::size_t i = 0; i < y.size(); ++i) {
        const double expected = std::atan2(double{y[i]}, double{x[i]}) / y[i];
        ASSERT_NEAR(angles[i] / expected, 1, 4e-7) << y[i] << ", " << x[i];
    }
}

}  // namespace
}  // namespace hemirad::test::point_to_polygon_test
