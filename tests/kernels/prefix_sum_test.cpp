#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test {
namespace {

struct Sums {
    std::vector<std::int32_t> values;
    device::Shot shot;
};

std::vector<std::int32_t> random_counts(std::size_t size) {
    std::mt19937 random(50);
    std::vector<std::int32_t> counts(size);
    for (auto& count : counts) count = static_cast<std::int32_t>(random() % 5);
    return counts;
}

// One array of as many PEs as the parameter says.
class PrefixSum : public testing::TestWithParam<std::uint32_t> {
  protected:
    PrefixSum() : run_("prefix_sum", options()) {}

    Sums summed(const std::vector<std::int32_t>& counts, std::uint32_t capacity,
                std::int32_t status = kRunning) {
        device::Shot shot{};
        shot.status = status;
        auto plural = run_.plural(std::vector{shot});
        auto values = run_.plural(counts);
        run_.issue({1, GetParam()}, plural, values, std::int32_t(counts.size()), capacity);
        return {run_.acu().unload(values), run_.acu().unload(plural).front()};
    }

  private:
    static KernelOptions options() {
        KernelOptions result;
        result.prefix_pes = GetParam();
        return result;
    }

    KernelRun run_;
};

INSTANTIATE_TEST_SUITE_P(Pes, PrefixSum, testing::Values(1u, 3u, 64u, 256u));

TEST_P(PrefixSum, EveryEntryBecomesTheSumOfThoseBefore) {
    for (const std::size_t size : {0u, 1u, 2u, 63u, 64u, 65u, 1000u, 65537u}) {
        const auto counts = random_counts(size);

        const auto sums = summed(counts, 1u << 20);

        std::vector<std::int32_t> expected(size);
        std::exclusive_scan(counts.begin(), counts.end(), expected.begin(), 0);
        EXPECT_EQ(sums.values, expected) << size << " entries";
        EXPECT_EQ(sums.shot.bin_entries, std::accumulate(counts.begin(), counts.end(), 0u));
        EXPECT_EQ(sums.shot.status, kRunning);
    }
}

TEST_P(PrefixSum, ListsThatJustFitDoNotHaltTheShot) {
    EXPECT_EQ(summed({3, 4, 5}, 12).shot.status, kRunning);
}

TEST_P(PrefixSum, OneEntryTooManyHaltsTheShotAndSaysHowManyThereAre) {
    const auto sums = summed({3, 4, 5}, 11);

    EXPECT_EQ(sums.shot.status, kBinsFull);
    EXPECT_EQ(sums.shot.bin_entries, 12u);
}

TEST_P(PrefixSum, AHaltedShotKeepsItsEntries) {
    const auto sums = summed({3, 4, 5}, 12, kConverged);

    EXPECT_EQ(sums.values, (std::vector<std::int32_t>{3, 4, 5}));
    EXPECT_EQ(sums.shot.bin_entries, 0u);
}

}  // namespace
}  // namespace hemirad::test
