#include "formfactor/enforce.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace hemirad::enforce_test {
namespace {

/// Rows of a dense matrix; zeros are left out.
FormFactors factors_of(const std::vector<double>& area,
                       const std::vector<std::vector<double>>& matrix,
                       const std::vector<double>& outside, float error = 0) {
    FormFactors factors{{}, {}, outside, area};
    for (std::uint32_t i = 0; i < area.size(); ++i) {
        factors.from.push_back(i);
        factors.rows.emplace_back();
        for (std::uint32_t j = 0; j < matrix[i].size(); ++j)
            if (matrix[i][j] != 0) factors.rows[i].push_back({j, error, matrix[i][j]});
    }
    return factors;
}

/// Random rows that hold neither law; of a closed scene the last row sees all.
FormFactors noisy(std::uint32_t count, bool is_open) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(0.5, 1.5);
    std::vector<double> area, outside(count);
    for (std::uint32_t i = 0; i < count; ++i) area.push_back(uniform(random));
    std::vector matrix(count, std::vector<double>(count));
    for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t j = 0; j < count; ++j)
            if (i != j && (i + j) % 3 != 0) matrix[i][j] = 1.5 / count * uniform(random) / area[i];
    for (auto& leaving : outside) leaving = is_open ? 0.3 * uniform(random) : 0;
    return factors_of(area, matrix, outside);
}

void expect_within_0_and_1(const FormFactors& factors) {
    for (const auto& row : factors.rows)
        for (const FormFactor& f : row) {
            EXPECT_GE(f.value, 0);
            EXPECT_LE(f.value, 1);
        }
}

TEST(Enforce, OfTwoFindingsOfAPairTheMeanIsTaken) {
    // The same error, the same area: halfway. Outside takes what the rows lack.
    FormFactors factors = factors_of({1, 1}, {{0, 0.2}, {0.4, 0}}, {0.5, 0.5}, 1e-6F);

    enforce(factors);

    EXPECT_NEAR(factors.at(0, 1), 0.3, 1e-9);
    EXPECT_NEAR(factors.at(1, 0), 0.3, 1e-9);
    EXPECT_NEAR(factors.outside[0], 0.7, 1e-9);
}

TEST(Enforce, TheSurerFindingCountsMore) {
    FormFactors factors = factors_of({1, 1}, {{0, 0.2}, {0.4, 0}}, {0.5, 0.5});
    factors.rows[0][0].error = 1e-7F;
    factors.rows[1][0].error = 3e-7F;

    enforce(factors);

    // Weights 1 / error^2, 9 to 1.
    EXPECT_NEAR(factors.at(0, 1), (9 * 0.2 + 0.4) / 10, 1e-8);
}

TEST(Enforce, AWeighedLeastSquaresProblemSolvedByHand) {
    // Three faces that see each other, sums 1.1, 1.1 and 1.2. By symmetry G01 changes by x, the
    // others by y: x + y = -0.1, 2 y = -0.2, whatever the weights.
    FormFactors factors =
        factors_of({1, 1, 1}, {{0, 0.5, 0.6}, {0.5, 0, 0.6}, {0.6, 0.6, 0}}, {0, 0, 0}, 0.01F);

    enforce(factors);

    EXPECT_NEAR(factors.at(0, 1), 0.5, 1e-12);
    EXPECT_NEAR(factors.at(0, 2), 0.5, 1e-12);
    EXPECT_NEAR(factors.at(1, 2), 0.5, 1e-12);
}

TEST(Enforce, TheLeastChangeIsSpreadByVariance) {
    // One row of interest: it lacks 0.3, its factors have variances 1, 4 and 1 (1e-6). What it
    // sees is open, so that the other rows give way.
    FormFactors factors =
        factors_of({1, 1e6, 1e6, 1e6}, {{0, 0.2, 0.2, 0.3}, {0}, {0}, {0}}, {0, 1, 1, 1});
    factors.rows[0][0].error = 1e-3F;
    factors.rows[0][1].error = 2e-3F;
    factors.rows[0][2].error = 1e-3F;

    enforce(factors);

    EXPECT_NEAR(factors.at(0, 1), 0.25, 1e-6);
    EXPECT_NEAR(factors.at(0, 2), 0.40, 1e-6);
    EXPECT_NEAR(factors.at(0, 3), 0.35, 1e-6);
}

TEST(Enforce, APairThatBothHaveSeenHasHalfTheVariance) {
    // Row 0 lacks 0.3: of it 0.1 goes to the pair of two findings, 0.2 to that of one.
    FormFactors factors = factors_of({1, 1e6, 1e6}, {{0, 0.3, 0.4}, {3e-7}, {0}}, {0, 1, 1}, 1e-3F);
    factors.rows[1][0].error = 1e-9F;

    enforce(factors);

    EXPECT_NEAR(factors.at(0, 1), 0.4, 1e-6);
    EXPECT_NEAR(factors.at(0, 2), 0.6, 1e-6);
}

TEST(Enforce, ErrorsGoWithTheAreas) {
    FormFactors factors = factors_of({1, 4}, {{0, 0.4}, {0, 0}}, {0.6, 1}, 0.01F);

    enforce(factors);

    EXPECT_FLOAT_EQ(factors.rows[0][0].error, 0.01F);
    EXPECT_FLOAT_EQ(factors.rows[1][0].error, 0.0025F);
}

TEST(Enforce, RowsStayInOrder) {
    // Patch 0 has seen 3, and is seen by 1 and 2.
    FormFactors factors =
        factors_of({1, 1, 1, 1}, {{0, 0, 0, 0.1}, {0.1}, {0.1}, {0}}, {0.5, 0.5, 0.5, 0.5});

    enforce(factors);

    for (const auto& row : factors.rows)
        EXPECT_TRUE(std::ranges::is_sorted(row, {}, &FormFactor::to));
    EXPECT_EQ(factors.rows[0].size(), 3u);
}

TEST(Enforce, AZeroThatIsListedStaysZeroToo) {
    FormFactors factors = factors_of({1, 1, 1}, {{0, 0.5}, {0.5}, {0}}, {0, 0.5, 1}, 0.1F);
    factors.rows[0].push_back({2, 0.1F, 0});

    enforce(factors);

    EXPECT_EQ(factors.at(0, 2), 0);
    EXPECT_NEAR(factors.at(0, 1), 1, 1e-12);
}

class BothLaws : public ::testing::TestWithParam<bool> {};

TEST_P(BothLaws, HoldAfterwards) {
    FormFactors factors = noisy(60, GetParam());
    ASSERT_GT(closure_error(factors), 0.1);
    ASSERT_GT(reciprocity_error(factors), 1e-3);

    enforce(factors);

    EXPECT_LT(closure_error(factors), 1e-12);
    EXPECT_LT(reciprocity_error(factors), 1e-15);
    expect_within_0_and_1(factors);
}

INSTANTIATE_TEST_SUITE_P(OfScenes, BothLaws, ::testing::Values(true, false));

TEST(Enforce, ZerosStayZero) {
    FormFactors factors = noisy(20, false);

    enforce(factors);

    for (std::uint32_t i = 0; i < 20; ++i) {
        EXPECT_EQ(factors.outside[i], 0);
        for (std::uint32_t j = i % 3 == 0 ? 0 : 3 - i % 3; j < 20; j += 3)
            EXPECT_EQ(factors.at(i, j), 0) << i << ' ' << j;
    }
}

TEST(Enforce, WhatHoldsIsLeftAsItIs) {
    // A cube's faces: 0.2 each, to within rounding.
    std::vector cube(6, std::vector<double>(6, 0.2));
    for (std::size_t i = 0; i < 6; ++i) cube[i][i] = 0;
    FormFactors factors = factors_of(std::vector<double>(6, 1.0), cube, std::vector<double>(6));

    enforce(factors);

    for (std::uint32_t i = 0; i < 6; ++i)
        for (std::uint32_t j = 0; j < 6; ++j) EXPECT_NEAR(factors.at(i, j), cube[i][j], 1e-15);
}

TEST(Enforce, NothingBecomesNegative) {
    // Row 0 is far too full, and its smallest factor has the largest error.
    FormFactors factors =
        factors_of({1, 4, 4}, {{0, 1.2, 0.01}, {0.3, 0, 0}, {0.0025, 0, 0}}, {0, 0.7, 1}, 1e-3F);
    factors.rows[0][1].error = factors.rows[2][0].error = 1;

    enforce(factors);

    EXPECT_EQ(factors.rows[0].size(), 1u);
    EXPECT_NEAR(factors.at(0, 1), 1, 1e-12);
    EXPECT_LT(closure_error(factors), 1e-12);
    expect_within_0_and_1(factors);
}

TEST(Enforce, APairThatOneSideAloneHasSeenIsAPair) {
    FormFactors factors = factors_of({1, 4}, {{0, 0.4}, {0, 0}}, {0.6, 1});

    enforce(factors);

    EXPECT_GT(factors.at(1, 0), 0);
    EXPECT_NEAR(factors.at(0, 1), 4 * factors.at(1, 0), 1e-15);
    EXPECT_LT(closure_error(factors), 1e-12);
}

TEST(Enforce, WhatNoFactorsCanHoldStaysAnError) {
    // Two faces of different areas cannot see each other alone.
    FormFactors factors = factors_of({1, 2}, {{0, 1}, {1, 0}}, {0, 0});

    enforce(factors);

    EXPECT_GT(closure_error(factors), 0.1);
    EXPECT_LT(reciprocity_error(factors), 1e-12);
    expect_within_0_and_1(factors);
}

/// Areas, factors and errors over decades; most rows sum to far more or less than 1.
FormFactors mostly_wrong(unsigned seed, bool is_open) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const std::uint32_t count = 4 + seed % 12;
    std::vector<double> area, outside(count);
    for (std::uint32_t i = 0; i < count; ++i) area.push_back(std::pow(10, -2 * uniform(random)));
    for (auto& leaving : outside) leaving = is_open ? 0.1 * uniform(random) : 0;
    std::vector matrix(count, std::vector<double>(count));
    for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t j = 0; j < count; ++j)
            if (i != j) matrix[i][j] = 60.0 / count * std::pow(uniform(random), 3) * area[j];
    FormFactors factors = factors_of(area, matrix, outside);
    for (auto& row : factors.rows)
        for (FormFactor& f : row) f.error = float(std::pow(10, -4 * uniform(random)));
    return factors;
}

/// A face larger than all others together cannot see them alone.
bool can_be_closed(const std::vector<double>& area) {
    const double largest = *std::ranges::max_element(area);
    return largest < 0.9 * (std::accumulate(area.begin(), area.end(), 0.0) - largest);
}

TEST(Enforce, FactorsThatAreMostlyWrong) {
    int solved = 0;
    for (unsigned seed = 0; seed < 20000; ++seed) {
        FormFactors factors = mostly_wrong(seed, seed % 2 == 0);
        if (seed % 2 == 1 && !can_be_closed(factors.area)) continue;

        enforce(factors);

        ++solved;
        EXPECT_LT(closure_error(factors), 1e-12) << seed;
        EXPECT_LT(reciprocity_error(factors), 1e-15) << seed;
        expect_within_0_and_1(factors);
        for (const auto& row : factors.rows)  // what has become 0 is gone
            for (const FormFactor& f : row) EXPECT_GT(f.value, 1e-15) << seed;
    }
    EXPECT_GT(solved, 15000);
}

TEST(Enforce, WhereThreeFacesCannotHoldTheLawsTheNearestIsTaken) {
    FormFactors factors =
        factors_of({1, 1, 10}, {{0, 0.1, 0.9}, {0.1, 0, 0.9}, {0.5, 0.5, 0}}, {0, 0, 0}, 0.1F);

    enforce(factors);

    EXPECT_LT(closure_error(factors), 0.9);
    EXPECT_GT(factors.at(0, 2), 0.9);
    EXPECT_LT(reciprocity_error(factors), 1e-15);
    expect_within_0_and_1(factors);
}

TEST(Enforce, AThousandPatchesOfVeryDifferentSizes) {
    FormFactors factors = noisy(1000, false);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const double scale = std::pow(10.0, -double(i % 5));
        factors.area[i] *= scale;
        for (auto& row : factors.rows)
            for (FormFactor& f : row)
                if (f.to == i) f.value *= scale;
    }

    enforce(factors);

    EXPECT_LT(closure_error(factors), 1e-12);
    EXPECT_LT(reciprocity_error(factors), 1e-15);
    expect_within_0_and_1(factors);
}

}  // namespace
}  // namespace hemirad::enforce_test
