#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/probe.h"

namespace hemirad::test::compensated_test {
namespace {

struct Sum {
    float sum = 0, rest = 0;
};

// Of every lane, as add_compensated adds.
Sum expected_sum(const std::vector<float>& values, std::size_t lanes, std::size_t lane) {
    Sum result;
    for (std::size_t i = lane; i < values.size(); i += lanes) {
        const float increment = values[i] + result.rest;
        const float total = result.sum + increment;
        const float part = total - result.sum;
        result.rest = (result.sum - (total - part)) + (increment - part);
        result.sum = total;
    }
    return result;
}

class Compensated : public testing::TestWithParam<std::uint32_t> {
  protected:
    std::vector<Sum> sums_of(const std::vector<float>& values) {
        const std::uint32_t lanes = GetParam();
        auto run = KernelRun::probe("compensated", "add_all", probe_options(lanes));
        auto sums = run.acu().plural<float>(lanes), rests = run.acu().plural<float>(lanes);
        run.issue({1, 1}, run.plural(values), std::int32_t(values.size() / lanes), sums, rests);
        const auto sum = run.acu().unload(sums), rest = run.acu().unload(rests);
        std::vector<Sum> result;
        for (std::size_t lane = 0; lane < lanes; ++lane) result.push_back({sum[lane], rest[lane]});
        return result;
    }
};

INSTANTIATE_TEST_SUITE_P(Lanes, Compensated, testing::ValuesIn(all_lanes()));

TEST_P(Compensated, AMillionAdditionsLoseNoMoreThanTheRoundingOfTheLastRest) {
    const std::size_t lanes = GetParam();
    std::mt19937 random(80);
    std::uniform_real_distribution<float> exponent(-20, 0);
    std::vector<float> values(1000000 * lanes);
    for (float& value : values) value = std::exp2(exponent(random));

    const auto sums = sums_of(values);

    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const auto expected = expected_sum(values, lanes, lane);
        EXPECT_EQ(sums[lane].sum, expected.sum);
        EXPECT_EQ(sums[lane].rest, expected.rest);
        long double exact_sum = 0, plain_error = 0;
        float plain = 0;
        for (std::size_t i = lane; i < values.size(); i += lanes) {
            exact_sum += values[i];
            plain += values[i];
        }
        plain_error = std::abs(plain - exact_sum) / exact_sum;
        const long double error =
            std::abs(static_cast<long double>(sums[lane].sum) + sums[lane].rest - exact_sum);
        // Each increment is rounded once: at worst half an ulp of every value, 2^-24 of the sum.
        EXPECT_LT(error / exact_sum, 0x1p-24L);
        EXPECT_GT(plain_error, 0x1p-20L);
    }
}

TEST_P(Compensated, WhatIsFarBelowTheSumIsKept) {
    const std::size_t lanes = GetParam();
    std::vector<float> values(1001 * lanes, 0x1p-30f);  // a thousandth of an ulp of 1
    std::fill_n(values.begin(), lanes, 1.0f);

    for (const auto& [sum, rest] : sums_of(values))
        EXPECT_EQ(double{sum} + rest, 1 + 1000 * 0x1p-30);
}

}  // namespace
}  // namespace hemirad::test::compensated_test
