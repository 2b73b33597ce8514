#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test {
namespace {

constexpr std::int32_t kDiskProxels = 250;
constexpr std::uint32_t kParts = 4;

// What choose_shooter reads: a shot that found its patches, in blocks.
struct Books {
    std::size_t bands = 1;
    device::Shot shot{};
    std::vector<device::BlockSummary> summaries;
    std::vector<float> block_unshot;  // [block][band]
    std::vector<float> unshot;        // [band][patch]
    std::vector<float> weight, flux;  // [band]
    std::vector<float> escaped;       // [sum, rest][band]
    std::int32_t escaped_count = 0, owned_count = 0;
    std::int32_t row_capacity = 0;
    std::vector<std::int32_t> row_of;  // [patch]
    std::vector<float> row_escaped;    // [row]
    float tolerance = 1e-3f;

    std::size_t stride() const { return summaries.size() * kReduceBlock; }
};

// `blocks` of which each has its most energetic patch in the middle.
Books random_books(std::size_t blocks, std::size_t bands) {
    std::mt19937 random(70);
    std::uniform_real_distribution<float> unit(0, 1);
    Books books;
    books.bands = bands;
    books.shot.status = kRunning;
    books.shot.shooter = 3;
    books.shot.shots = 41;
    books.shot.part = books.shot.part_count = kParts;
    books.shot.shot_limit = std::numeric_limits<std::uint32_t>::max();
    books.shot.least_surplus = std::numeric_limits<std::int32_t>::max();
    books.shot.most_surplus = std::numeric_limits<std::int32_t>::min();
    for (std::size_t block = 0; block < blocks; ++block) {
        books.summaries.push_back(
            {unit(random), static_cast<std::int32_t>(block * kReduceBlock + 32)});
        for (std::size_t band = 0; band < bands; ++band) books.block_unshot.push_back(unit(random));
    }
    for (std::size_t i = 0; i < bands * books.stride(); ++i) books.unshot.push_back(unit(random));
    for (std::size_t band = 0; band < bands; ++band) {
        books.weight.push_back(unit(random));
        books.flux.push_back(unit(random));
    }
    books.escaped.assign(2 * bands, 0.0f);
    books.row_of.assign(books.stride(), 0);
    books.row_escaped.assign(8, 0.0f);
    return books;
}

// One array of as many PEs as the parameter says.
class ChooseShooter : public testing::TestWithParam<std::uint32_t> {
  protected:
    /// The books after the kernel. Counts of patches do not matter to it.
    Books closed(const Books& books) {
        KernelOptions options;
        options.bands = static_cast<std::uint32_t>(books.bands);
        options.reduce_pes = GetParam();
        KernelRun run("choose_shooter", options);
        auto shot = run.plural(std::vector{books.shot});
        std::vector<std::int32_t> counts(books.stride() + kSpareCounts, 0);
        counts[books.stride()] = books.escaped_count;
        counts[books.stride() + 1] = 5;  // outside the disk
        counts[books.stride() + 2] = books.owned_count;
        auto proxel_count = run.plural(counts);
        auto escaped = run.plural(books.escaped), flux = run.plural(books.flux);
        auto row_of = run.plural(books.row_of);
        auto row_escaped = run.plural(books.row_escaped);
        run.issue({1, GetParam()}, shot, run.plural(books.summaries),
                  run.plural(books.block_unshot), std::int32_t(books.summaries.size()),
                  run.plural(books.unshot), std::int32_t(books.stride()), run.plural(books.weight),
                  books.tolerance, kDiskProxels, proxel_count, std::int32_t(books.stride()),
                  escaped, flux, books.row_capacity, row_of, row_escaped);
        Books result = books;
        result.shot = run.acu().unload(shot).front();
        result.escaped = run.acu().unload(escaped);
        result.flux = run.acu().unload(flux);
        result.row_of = run.acu().unload(row_of);
        result.row_escaped = run.acu().unload(row_escaped);
        counts_ = run.acu().unload(proxel_count);
        return result;
    }

    std::vector<std::int32_t> counts_;
};

// Unshot flux of a band, added up by one array: each PE its blocks, then PE after PE.
float added_unshot(const Books& books, std::size_t band, std::size_t pes) {
    std::vector<float> left(pes, 0.0f);
    for (std::size_t block = 0; block < books.summaries.size(); ++block)
        left[block % pes] += books.block_unshot[block * books.bands + band];
    float total = left[0];
    for (std::size_t pe = 1; pe < pes; ++pe) total += left[pe];
    return total;
}

INSTANTIATE_TEST_SUITE_P(Pes, ChooseShooter, testing::Values(1u, 3u, 64u));

TEST_P(ChooseShooter, TheMostEnergeticPatchOfAllBlocksShootsNextWithItsUnshotFlux) {
    for (const std::size_t blocks : {1u, 2u, 64u, 200u}) {
        const auto books = random_books(blocks, 3);
        const auto most =
            std::max_element(books.summaries.begin(), books.summaries.end(),
                             [](const auto& a, const auto& b) { return a.energy < b.energy; });

        const auto after = closed(books);

        EXPECT_EQ(after.shot.shooter, most->shooter);
        for (std::size_t band = 0; band < 3; ++band)
            EXPECT_EQ(after.flux[band], books.unshot[band * books.stride() + most->shooter]);
        EXPECT_EQ(after.shot.status, kRunning);
    }
}

TEST_P(ChooseShooter, TiesGoToTheLowestPatch) {
    auto books = random_books(200, 1);
    for (const std::size_t block : {17u, 80u, 81u, 199u}) books.summaries[block].energy = 2;

    EXPECT_EQ(closed(books).shot.shooter, 17 * kReduceBlock + 32);
}

TEST_P(ChooseShooter, TheUnshotFractionIsThatOfTheBandWithTheLargest) {
    const auto books = random_books(200, 3);

    const auto after = closed(books);

    float expected = 0;
    for (std::size_t band = 0; band < 3; ++band)
        expected = std::max(expected, added_unshot(books, band, GetParam()) * books.weight[band]);
    EXPECT_EQ(after.shot.unshot_fraction, expected);
}

TEST_P(ChooseShooter, TheBooksOfTheShotAreClosed) {
    auto books = random_books(30, 2);
    books.escaped = {0.5f, 0.25f, 0, 0};
    books.escaped_count = 40;
    books.owned_count = 300;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, 42u);
    EXPECT_EQ(after.shot.repeated_shots, 0u);
    EXPECT_EQ(after.shot.escaped_proxels, 40u);
    EXPECT_EQ(after.shot.least_surplus, 340 - 1000);
    EXPECT_EQ(after.shot.most_surplus, 340 - 1000);
    EXPECT_EQ(after.shot.part, 0u);
    for (std::size_t band = 0; band < 2; ++band) {
        // Two-sum is exact: sum and rest together are the sum in double precision.
        const float flux = books.flux[band] * (40.0f / (kDiskProxels * kParts));
        EXPECT_EQ(double{after.escaped[band]} + after.escaped[2 + band],
                  double{books.escaped[band]} + flux);
    }
    EXPECT_EQ(counts_[books.stride()], 0);
    EXPECT_EQ(counts_[books.stride() + 1], 0);
    EXPECT_EQ(counts_[books.stride() + 2], 0);
}

TEST_P(ChooseShooter, RowsAreKeptWhileThereIsRoom) {
    auto books = random_books(30, 1);
    books.row_capacity = 3;
    books.shot.row = 2;
    books.shot.rows_kept = 2;
    books.escaped_count = 40;

    const auto after = closed(books);

    EXPECT_EQ(after.row_of[books.shot.shooter], 3);
    EXPECT_EQ(after.row_escaped[2], 40.0f / (kDiskProxels * kParts));
    EXPECT_EQ(after.shot.rows_kept, 3u);
    EXPECT_EQ(after.shot.row, 3);
    EXPECT_FALSE(after.shot.row_known);
}

TEST_P(ChooseShooter, ARowBeyondThoseIsForgotten) {
    auto books = random_books(30, 1);
    books.row_capacity = 3;
    books.shot.row = 3;
    books.shot.rows_kept = 3;

    const auto after = closed(books);

    EXPECT_EQ(after.row_of, books.row_of);
    EXPECT_EQ(after.shot.rows_kept, 3u);
    EXPECT_EQ(after.shot.row, 3);
}

TEST_P(ChooseShooter, AShooterWhoseRowIsKnownNeedsNoHemisphere) {
    auto books = random_books(1, 1);
    books.row_capacity = 3;
    books.shot.row = 1;
    books.shot.rows_kept = 1;
    books.row_of[32] = 1;

    const auto after = closed(books);

    EXPECT_TRUE(after.shot.row_known);
    EXPECT_EQ(after.shot.row, 0);
    EXPECT_GE(after.shot.part, after.shot.part_count);
}

TEST_P(ChooseShooter, AShooterWhoseRowIsNotKnownHasHemispheresToMake) {
    auto books = random_books(1, 1);
    books.shot.part = books.shot.part_count = 0;

    const auto after = closed(books);

    EXPECT_FALSE(after.shot.row_known);
    EXPECT_LT(after.shot.part, after.shot.part_count);
}

TEST_P(ChooseShooter, AKnownRowBringsItsShareOfEscapesAndNoProxels) {
    auto books = random_books(30, 2);
    books.shot.row_known = 1;
    books.shot.row = 1;
    books.row_escaped[1] = 0.25f;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, 42u);
    EXPECT_EQ(after.shot.repeated_shots, 1u);
    EXPECT_EQ(after.shot.least_surplus, books.shot.least_surplus);
    EXPECT_EQ(after.shot.most_surplus, books.shot.most_surplus);
    EXPECT_EQ(after.row_of, books.row_of);
    for (std::size_t band = 0; band < 2; ++band)
        EXPECT_EQ(after.escaped[band], 0.25f * books.flux[band]);
}

TEST_P(ChooseShooter, BeforeTheFirstShotThereAreNoBooksToClose) {
    auto books = random_books(30, 1);
    books.shot.shooter = -1;
    books.shot.shots = 0;
    books.escaped_count = 40;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, 0u);
    EXPECT_EQ(after.shot.most_surplus, books.shot.most_surplus);
    EXPECT_EQ(after.escaped[0], 0.0f);
    EXPECT_GE(after.shot.shooter, 0);
}

TEST_P(ChooseShooter, NothingIsClosedBeforeTheShootersLastHemisphere) {
    auto books = random_books(30, 1);
    books.shot.part = kParts - 1;
    books.escaped_count = 40;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, books.shot.shots);
    EXPECT_EQ(after.shot.shooter, books.shot.shooter);
    EXPECT_EQ(after.shot.part, kParts - 1);
    EXPECT_EQ(counts_[books.stride()], 40);
}

TEST_P(ChooseShooter, ItPausesAtTheLimitOfShots) {
    auto books = random_books(30, 1);

    books.shot.shot_limit = 43;
    EXPECT_EQ(closed(books).shot.status, kRunning);
    books.shot.shot_limit = 42;
    EXPECT_EQ(closed(books).shot.status, kPaused);
}

TEST_P(ChooseShooter, ItConvergesBelowTheToleranceAndNotAtIt) {
    auto books = random_books(1, 1);
    books.weight = {1};
    books.block_unshot = {0.125f};

    books.tolerance = 0.125f;
    EXPECT_EQ(closed(books).shot.status, kRunning);
    books.tolerance = 0.1251f;
    EXPECT_EQ(closed(books).shot.status, kConverged);
}

TEST_P(ChooseShooter, WithoutEnergyNothingIsLeftToShoot) {
    auto books = random_books(3, 1);
    books.tolerance = 0;
    for (const float energy : {0.0f, 1e-40f, std::numeric_limits<float>::min()}) {
        for (auto& summary : books.summaries) summary.energy = energy;

        EXPECT_EQ(closed(books).shot.status, kExhausted) << energy;
    }
}

TEST_P(ChooseShooter, AHaltedShotKeepsItsShooterAndItsBooks) {
    auto books = random_books(30, 1);
    books.shot.status = kBinsFull;
    books.escaped_count = 40;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shooter, 3);
    EXPECT_EQ(after.shot.shots, 41u);
    EXPECT_EQ(after.flux, books.flux);
    EXPECT_EQ(counts_[books.stride()], 40);
}

}  // namespace
}  // namespace hemirad::test
