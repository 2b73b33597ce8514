#include <gtest/gtest.h>

#include "reference/closed_forms.h"
#include "support/pipeline.h"

namespace hemirad::test::estimate_form_factors_test {
namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

PipelineSettings analytic() {
    PipelineSettings settings;
    settings.form_factor = FormFactorMode::analytic;
    return settings;
}

// What patch 0, a floor, sees by one hemisphere.
class EstimateFormFactors : public testing::TestWithParam<Shape> {
  protected:
    struct Sums {
        std::vector<float> visible, unblocked, doubtful;
    };
    Sums seen_by_first(const std::vector<Polygon>& polygons, std::uint32_t resolution = 64) {
        Aimed aimed(polygons, GetParam(), resolution, analytic());
        aimed.aim(0);
        aimed.project();
        const auto all = aimed.pipeline().factors();
        const auto kind = [&](std::size_t at) {
            const auto first = all.begin() + std::ptrdiff_t(at * aimed.pipeline().stride());
            return std::vector<float>(first, first + std::ptrdiff_t(polygons.size()));
        };
        counts_ = aimed.pipeline().proxel_counts();
        return {kind(kVisibleFactor), kind(kUnblockedFactor), kind(kDoubtfulFactor)};
    }
    static double closed_form(const Polygon& to) {
        return reference::point_to_polygon({0, 0, 0}, {0, 0, 1}, to.corners);
    }

    std::vector<std::int32_t> counts_;
};

INSTANTIATE_TEST_SUITE_P(Shapes, EstimateFormFactors, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

const Polygon kFloor = square({0, 0, 0}, kX, kY, 1);

TEST_P(EstimateFormFactors, WhatNothingHidesHasItsClosedForm) {
    const auto ceiling = square({0.3, 0.1, 1}, kY, kX, 1.5);

    const auto sums = seen_by_first({kFloor, ceiling});

    EXPECT_NEAR(sums.visible[1], closed_form(ceiling), 1e-6);
    EXPECT_EQ(sums.visible[1], sums.unblocked[1]);
    EXPECT_EQ(sums.doubtful[1], 0);
}

TEST_P(EstimateFormFactors, WhatIsHiddenHalfHasHalfOfIt) {
    const auto far = square({0, 0, 2}, kY, kX, 1), near = square({10, 0, 1}, kY, kX, 20);

    const auto sums = seen_by_first({kFloor, far, near}, 512);

    const double whole = closed_form(far);
    EXPECT_NEAR(sums.unblocked[1], whole, 1e-6);
    EXPECT_NEAR(sums.visible[1], whole / 2, 2e-3 * whole);
    EXPECT_NEAR(sums.doubtful[1], whole / 4, 2e-3 * whole);
}

TEST_P(EstimateFormFactors, APatchBetweenProxelsIsAsVisibleAsItsMiddle) {
    const auto speck = [&](double x, double z) { return square({x, 0.01, z}, kY, kX, 1e-4); };
    const auto ceiling = square({2, 0, 1}, kY, kX, 4);  // from x = 0 on

    const auto sums = seen_by_first(
        {kFloor, ceiling, speck(-0.3, 0.9), speck(0.3, 0.9), speck(0.31, 1.1), speck(0.29, 1)});

    EXPECT_NEAR(sums.visible[2] / closed_form(speck(-0.3, 0.9)), 1, 1e-2);  // beside it
    EXPECT_EQ(sums.visible[3], sums.unblocked[3]);                          // before it
    EXPECT_GT(sums.unblocked[4], 0);
    EXPECT_EQ(sums.visible[4], 0);                  // behind it
    EXPECT_EQ(sums.visible[5], sums.unblocked[5]);  // in its plane
}

// A proxel is 0.03 wide here; the ceiling's edge passes at x = 0.003 to 0.03 and 3 in 10 of that
// before and behind it.
TEST_P(EstimateFormFactors, WhatLiesBetweenProxelsIsHiddenUpToTheOutlineBeforeIt) {
    for (int i = 1; i <= 10; ++i) {
        const double edge = 3e-3 * i;
        const auto ceiling = square({edge + 2, 0, 1}, kY, kX, 4);
        const auto speck = [&](double x) { return square({2 * x, 0.3, 2}, kY, kX, 1e-5); };

        const auto sums = seen_by_first({kFloor, ceiling, speck(edge - 1e-3), speck(edge + 1e-3)});

        EXPECT_EQ(sums.visible[2], sums.unblocked[2]) << edge;
        EXPECT_GT(sums.unblocked[3], 0) << edge;
        EXPECT_EQ(sums.visible[3], 0) << edge;
    }
}

// Other kernels, of three edges; one shape, as they take long to compile.
class EstimateFormFactorsOfTriangles : public EstimateFormFactors {};

INSTANTIATE_TEST_SUITE_P(Shapes, EstimateFormFactorsOfTriangles, testing::Values(shapes().front()),
                         [](const auto& shape) { return name_of(shape.param); });

// Each of the ceiling's edges in turns is the one that passes.
TEST_P(EstimateFormFactorsOfTriangles, AnyEdgeOfATriangleMayBeThatOutline) {
    const auto triangle = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        return Polygon{{a, b, c, c}};
    };
    const auto speck = [&](double x) {
        return triangle({2 * x, 0.3, 2}, {2 * x, 0.3 + 1e-5, 2}, {2 * x + 1e-5, 0.3, 2});
    };
    const glm::dvec3 a(0.01, -4, 1), b(0.01, 4, 1), c(4, 0, 1);
    const auto floor = triangle({-1, -1, 0}, {2, -1, 0}, {-1, 2, 0});
    for (const auto& ceiling : {triangle(a, b, c), triangle(c, a, b), triangle(b, c, a)}) {
        const auto sums = seen_by_first({floor, ceiling, speck(0.01 - 1e-3), speck(0.01 + 1e-3)});

        EXPECT_EQ(sums.visible[2], sums.unblocked[2]);
        EXPECT_GT(sums.unblocked[3], 0);
        EXPECT_EQ(sums.visible[3], 0);
    }
}

TEST_P(EstimateFormFactors, TheCountsAreSpentAndAddedUp) {
    seen_by_first({kFloor, square({0, 0, 1}, kY, kX, 1), square({0.2, 0, 2}, kY, kX, 3)});

    const auto escaped = counts_[counts_.size() - 3], owned = counts_.back();
    EXPECT_GT(owned, 0);
    EXPECT_EQ(static_cast<std::uint64_t>(owned + escaped), disk_proxel_count(64));
    EXPECT_EQ(std::count(counts_.begin(), counts_.end() - 3, 0),
              static_cast<std::ptrdiff_t>(counts_.size() - 3));
}

TEST_P(EstimateFormFactors, AClosedBoxAddsUpToOne) {
    const auto polygons = box({1, 0.7, 0.3}, 4);

    const auto sums = seen_by_first(polygons, 512);

    double sum = 0;
    for (const float factor : sums.visible) sum += factor;
    EXPECT_NEAR(sum, 1, 1e-4);
}

}  // namespace
}  // namespace hemirad::test::estimate_form_factors_test
