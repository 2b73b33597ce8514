#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/kept_rows.h"
#include "support/kernel_run.h"
#include "support/pipeline.h"

namespace hemirad::test::rows_test {
namespace {

constexpr std::uint32_t kBlocks = 37, kStride = kBlocks * kReduceBlock, kPes = 6;
constexpr std::uint32_t kPlenty = 1 << 16;  // units

// Blocks of zeros, blocks that are full, and all between.
std::vector<float> random_row(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<float> row(kStride);
    for (std::uint32_t block = 0; block < kBlocks; ++block) {
        const float share = static_cast<float>(random() % 5) / 4;
        for (std::uint32_t i = 0; i < kReduceBlock; ++i)
            if (unit(random) < share) row[block * kReduceBlock + i] = unit(random);
    }
    return row;
}

std::vector<float> joined(const std::vector<std::vector<float>>& rows) {
    std::vector<float> result;
    for (const auto& row : rows) result.insert(result.end(), row.begin(), row.end());
    return result;
}

class Rows : public testing::TestWithParam<std::uint32_t> {
  protected:
    KernelRun run(const char* name) {
        KernelOptions options;
        options.lanes = GetParam();
        return KernelRun::probe("rows", name, options);
    }

    /// Beside what `kept` holds.
    void keep(KeptRows& kept, const std::vector<std::vector<float>>& rows,
              const std::vector<std::int32_t>& places) {
        KernelRun& run = keeping_;
        auto words = run.plural(kept.words);
        auto pool = run.plural(kept.pool);
        auto extents = run.plural(kept.extents);
        run.issue({kPes / 2, 2}, run.plural(joined(rows)), std::int32_t(rows.size()),
                  std::int32_t(kStride), run.plural(places), words, pool, extents);
        kept.words = run.acu().unload(words);
        kept.pool = run.acu().unload(pool);
        kept.extents = run.acu().unload(extents);
    }

    KernelRun keeping_ = run("keep");

    std::vector<float> fetched(const KeptRows& kept, const std::vector<std::int32_t>& places) {
        auto run = this->run("fetch");
        auto values = run.plural(std::vector<float>(places.size() * kStride, NAN));
        run.issue({kPes / 2, 2}, values, std::int32_t(places.size()), std::int32_t(kStride),
                  run.plural(places), run.plural(kept.words), run.plural(kept.pool),
                  run.plural(kept.extents));
        return run.acu().unload(values);
    }
};

INSTANTIATE_TEST_SUITE_P(Lanes, Rows, testing::Values(1u, 4u, 8u, 16u));

TEST_P(Rows, AreKeptBitByBit) {
    KeptRows kept(kPlenty, kStride, kPes);
    const auto first = random_row(1), second = random_row(2), third = random_row(3);
    const std::vector<std::int32_t> places{kept.promise(), kept.promise()}, later{kept.promise()};

    keep(kept, {first, second}, places);
    keep(kept, {third}, later);

    EXPECT_FALSE(kept.is_full());
    EXPECT_EQ(bits(kept.row(places[0])), bits(first));
    EXPECT_EQ(bits(kept.row(places[1])), bits(second));
    EXPECT_EQ(bits(kept.row(later[0])), bits(third));
}

// What a PE writes at the end of an extent does not reach into another's, which was there before.
TEST_P(Rows, OfManyShotsStayAsTheyWere) {
    constexpr unsigned kRows = 40;
    KeptRows kept(kPlenty, kStride, kPes);
    std::vector<std::int32_t> places;
    for (unsigned i = 0; i < kRows; ++i) {
        places.push_back(kept.promise());
        keep(kept, {random_row(100 + i)}, {places.back()});
    }

    ASSERT_GT(kept.pool[0].taken, 5 * kPes * kExtentUnits);
    for (unsigned i = 0; i < kRows; ++i)
        EXPECT_EQ(bits(kept.row(places[i])), bits(random_row(100 + i))) << i;
}

TEST_P(Rows, AreFetchedBitByBit) {
    KeptRows kept(kPlenty, kStride, kPes);
    const auto first = random_row(4), second = random_row(5);
    const std::vector<std::int32_t> places{kept.keep(first), kept.keep(second)};

    EXPECT_EQ(bits(fetched(kept, places)), bits(joined({first, second})));
}

TEST_P(Rows, OfZerosTakeNoMoreThanTheirDirectory) {
    KeptRows kept(kPlenty, kStride, kPes);
    const auto place = kept.promise();
    const auto taken = kept.pool[0].taken;

    keep(kept, {std::vector<float>(kStride, 0.0f)}, {place});

    EXPECT_EQ(kept.pool[0].taken, taken);
    EXPECT_EQ(kept.row(place), std::vector<float>(kStride, 0.0f));
}

// Whoever has no room says so, and leaves everything else as it is.
TEST_P(Rows, ThatFindNoRoomAreTold) {
    for (const std::uint32_t extents : {0u, 1u, 4u}) {
        KeptRows kept(2 * kBlocks + extents * kExtentUnits, kStride, kPes);
        const auto known = random_row(6);
        std::vector<float> old(kStride, 0.0f);
        old[70] = 0.5f;
        const auto before = kept.keep(old);
        const auto place = kept.promise();

        keep(kept, {known}, {place});

        EXPECT_TRUE(kept.is_full()) << extents;
        EXPECT_TRUE(kept.is_whole()) << extents;
        EXPECT_EQ(kept.row(before), old) << extents;
    }
}

TEST_P(Rows, ThatFindRoomForAllAreNotTold) {
    KeptRows kept(kBlocks + kPes * kExtentUnits, kStride, kPes);
    const auto row = random_row(7);
    const auto place = kept.promise();

    keep(kept, {row}, {place});

    EXPECT_FALSE(kept.is_full());
    EXPECT_TRUE(kept.is_whole());
    EXPECT_EQ(kept.row(place), row);
}

}  // namespace
}  // namespace hemirad::test::rows_test
