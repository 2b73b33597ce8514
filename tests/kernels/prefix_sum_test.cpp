#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test::prefix_sum_test {
namespace {

constexpr std::uint32_t kResolution = 30;

// Counts of `stacks` PEs for as many tiles as a kernel was compiled for, [pe][tile].
struct Counts {
    std::size_t tiles = 0;
    std::vector<std::int32_t> values;

    std::size_t stacks() const { return values.size() / tiles; }
};

struct Sums {
    std::vector<std::int32_t> places, list_end;
    device::Shot shot;
};

Counts random_counts(std::size_t tiles, std::size_t stacks) {
    std::mt19937 random(50);
    Counts counts{tiles, std::vector<std::int32_t>(tiles * stacks)};
    for (auto& count : counts.values) count = static_cast<std::int32_t>(random() % 5);
    return counts;
}

// Lists lie tile by tile, and in each PE by PE.
Sums expected_sums(const Counts& counts) {
    Sums sums{std::vector<std::int32_t>(counts.values.size()), {}, {}};
    std::int32_t place = 0;
    for (std::size_t tile = 0; tile < counts.tiles; ++tile) {
        for (std::size_t pe = 0; pe < counts.stacks(); ++pe) {
            sums.places[pe * counts.tiles + tile] = place;
            place += counts.values[pe * counts.tiles + tile];
        }
        sums.list_end.push_back(place);
    }
    return sums;
}

// One array of as many PEs as the parameter says, and a plane of side x side tiles.
class PrefixSum : public testing::TestWithParam<std::uint32_t> {
  protected:
    Sums summed(const Counts& counts, std::uint32_t capacity, std::int32_t status = kRunning) {
        KernelOptions options;
        options.prefix_pes = GetParam();
        options.resolution = kResolution;
        const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(counts.tiles)));
        options.tile_width = options.tile_height = kResolution / side;
        KernelRun run("prefix_sum", options);
        device::Shot shot{};
        shot.status = status;
        auto plural = run.plural(std::vector{shot});
        auto places = run.plural(counts.values);
        auto list_end = run.plural(std::vector<std::int32_t>(counts.tiles, -7));
        run.issue({1, GetParam()}, plural, places, std::int32_t(counts.stacks()), list_end,
                  capacity);
        return {run.acu().unload(places), run.acu().unload(list_end),
                run.acu().unload(plural).front()};
    }
};

INSTANTIATE_TEST_SUITE_P(Pes, PrefixSum, testing::Values(1u, 3u, 64u, 256u));

TEST_P(PrefixSum, EveryPartOfATilesListBeginsWhereThePartBeforeEnds) {
    for (const std::size_t side : {1u, 2u, 15u, 30u})
        for (const std::size_t stacks : {1u, 2u, 33u}) {
            const auto counts = random_counts(side * side, stacks);

            const auto sums = summed(counts, 1u << 20);

            const auto expected = expected_sums(counts);
            EXPECT_EQ(sums.places, expected.places) << side * side << " tiles, " << stacks;
            EXPECT_EQ(sums.list_end, expected.list_end);
            EXPECT_EQ(std::int32_t(sums.shot.bin_entries), expected.list_end.back());
            EXPECT_EQ(sums.shot.status, kRunning);
        }
}

const Counts kTwelve{4, {3, 4, 5, 0}};

TEST_P(PrefixSum, ListsThatJustFitDoNotHaltTheShot) {
    EXPECT_EQ(summed(kTwelve, 12).shot.status, kRunning);
}

TEST_P(PrefixSum, OneEntryTooManyHaltsTheShotAndSaysHowManyThereAre) {
    const auto sums = summed(kTwelve, 11);

    EXPECT_EQ(sums.shot.status, kBinsFull);
    EXPECT_EQ(sums.shot.bin_entries, 12u);
}

TEST_P(PrefixSum, MoreEntriesThanAnIntegerHoldsHaltTheShot) {
    const std::int32_t most = std::numeric_limits<std::int32_t>::max();

    const auto sums = summed({4, {most, most, most, most}}, most);

    EXPECT_EQ(sums.shot.status, kBinsFull);
    EXPECT_EQ(sums.shot.bin_entries, std::numeric_limits<std::uint32_t>::max());
}

TEST_P(PrefixSum, AHaltedShotKeepsItsCounts) {
    const auto sums = summed(kTwelve, 12, kConverged);

    EXPECT_EQ(sums.places, kTwelve.values);
    EXPECT_EQ(sums.list_end, std::vector<std::int32_t>(4, -7));
    EXPECT_EQ(sums.shot.bin_entries, 0u);
}

}  // namespace
}  // namespace hemirad::test::prefix_sum_test
