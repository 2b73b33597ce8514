#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "support/probe.h"

namespace hemirad::test::lanes_test {
namespace {

constexpr std::size_t kCount = 256;

std::int32_t bits_of(float value) { return std::bit_cast<std::int32_t>(value); }

// One value after another, what probes/lanes.cl does with whole datapaths: [operation][count].
std::vector<std::int32_t> expected_results(const std::vector<float>& a, const std::vector<float>& b,
                                           const std::vector<std::int32_t>& index,
                                           std::size_t lanes) {
    std::vector<std::int32_t> result(9 * kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        const bool less = a[i] < b[i];
        bool any = false;
        for (std::size_t k = i / lanes * lanes; k < (i / lanes + 1) * lanes; ++k)
            any |= a[k] < b[k];
        result[i] = less ? -1 : 0;
        result[kCount + i] = bits_of(less ? a[i] : b[i]);
        result[2 * kCount + i] = less ? -1 : 0;
        result[3 * kCount + i] = static_cast<std::int32_t>(i);
        result[4 * kCount + i] = bits_of(static_cast<float>(index[i]));
        result[5 * kCount + i] = bits_of(a[i]);
        result[6 * kCount + i] = less ? -1 : 0;
        result[7 * kCount + i] = any;
        result[8 * kCount + i] = (less ? 1 : 0) << i % lanes;
    }
    return result;
}

class Lanes : public testing::TestWithParam<std::uint32_t> {};

INSTANTIATE_TEST_SUITE_P(All, Lanes, testing::ValuesIn(all_lanes()));

TEST_P(Lanes, EveryOperationIsTheScalarOneInEachLane) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<float> special = {
        0.0f, -0.0f, 1.0f, -1.0f, kInfinity, -kInfinity, std::numeric_limits<float>::quiet_NaN()};
    std::mt19937 random(90);
    std::vector<float> a, b;
    std::vector<std::int32_t> index;
    for (std::size_t i = 0; i < kCount; ++i) {
        a.push_back(special[random() % special.size()]);
        // Descending for a while, so that in some datapaths no lane is less.
        b.push_back(i < kCount / 2 ? special[random() % special.size()] : -kInfinity);
        index.push_back(static_cast<std::int32_t>(random() % kCount));
    }
    auto run = KernelRun::probe("lanes", "operate", probe_options(GetParam()));
    auto result = run.acu().plural<std::int32_t>(9 * kCount);

    run.issue(probe_grid(kCount, GetParam()), run.plural(a), run.plural(b), run.plural(index),
              std::int32_t(kCount), result);

    EXPECT_EQ(run.acu().unload(result), expected_results(a, b, index, GetParam()));
}

}  // namespace
}  // namespace hemirad::test::lanes_test
