#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test::choose_shooter_test {
namespace {

constexpr std::int32_t kDiskProxels = 250;
constexpr std::uint32_t kParts = 4;

// What choose_shooter reads: a shot that found its patches, in blocks.
struct Books {
    std::size_t bands = 1;
    device::Shot shot{};
    std::uint32_t salvo = 1;
    std::vector<device::Shot> others;  // of the salvo, and those that look ahead
    std::vector<device::BlockSummary> summaries;
    std::vector<float> block_unshot;  // [block][band]
    std::vector<float> unshot;        // [band][patch]
    std::vector<float> weight;        // [band]
    std::vector<float> flux;          // [shooter][band]
    std::vector<float> escaped;       // [sum, rest][band]
    std::int32_t escaped_count = 0, owned_count = 0;
    device::RowPool pool{1, 0};           // room for no row
    std::vector<std::int32_t> row_of;     // [patch]
    std::vector<float> row_escaped;       // [patch]
    std::vector<std::uint32_t> shots_of;  // [patch]; empty: not counted
    float tolerance = 1e-3f;

    std::size_t stride() const { return summaries.size() * kReduceBlock; }
    /// Units of a row's directory, a word a block.
    std::uint32_t directory() const {
        return static_cast<std::uint32_t>(summaries.size() + kRowUnit - 1) / kRowUnit;
    }
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
    books.row_escaped.assign(books.stride(), 0.0f);
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
        options.salvo = books.salvo;
        KernelRun run("choose_shooter", options);
        std::vector<device::Shot> salvo{books.shot};
        salvo.insert(salvo.end(), books.others.begin(), books.others.end());
        auto shot = run.plural(salvo);
        std::vector<std::int32_t> counts(books.salvo * (books.stride() + kCountsGap), 0);
        for (std::size_t station = 0; station < books.salvo; ++station) {
            auto* const spare =
                counts.data() + station * (books.stride() + kCountsGap) + books.stride();
            spare[0] = books.escaped_count;
            spare[1] = 5;  // outside the disk
            spare[2] = books.owned_count;
        }
        auto proxel_count = run.plural(counts);
        auto escaped = run.plural(books.escaped), flux = run.plural(books.flux);
        auto row_of = run.plural(books.row_of);
        auto row_escaped = run.plural(books.row_escaped);
        auto pool = run.plural(std::vector{books.pool});
        auto shots_of = run.plural(books.shots_of);
        run.issue({1, GetParam()}, shot, run.plural(books.summaries),
                  run.plural(books.block_unshot), std::int32_t(books.summaries.size()),
                  run.plural(books.unshot), std::int32_t(books.stride()), run.plural(books.weight),
                  books.tolerance, kDiskProxels, proxel_count, std::int32_t(books.stride()),
                  escaped, flux, pool, row_of, row_escaped, std::int32_t(!books.shots_of.empty()),
                  shots_of);
        Books result = books;
        salvo = run.acu().unload(shot);
        result.shot = salvo.front();
        result.others.assign(salvo.begin() + 1, salvo.end());
        result.escaped = run.acu().unload(escaped);
        result.flux = run.acu().unload(flux);
        result.row_of = run.acu().unload(row_of);
        result.pool = run.acu().unload(pool).front();
        result.row_escaped = run.acu().unload(row_escaped);
        result.shots_of = run.acu().unload(shots_of);
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

TEST_P(ChooseShooter, ARowThatHasAPlaceIsKept) {
    auto books = random_books(30, 1);
    books.pool = {500, 1000};
    books.shot.row = 77;
    books.shot.rows_kept = 2;
    books.escaped_count = 40;

    const auto after = closed(books);

    EXPECT_EQ(after.row_of[std::size_t(books.shot.shooter)], 77);
    EXPECT_EQ(after.row_escaped[std::size_t(books.shot.shooter)], 40.0f / (kDiskProxels * kParts));
    EXPECT_EQ(after.shot.rows_kept, 3u);
}

TEST_P(ChooseShooter, ARowWithoutAPlaceIsForgotten) {
    auto books = random_books(30, 1);
    books.pool = {500, 1000};
    books.shot.row = 0;
    books.shot.rows_kept = 2;

    const auto after = closed(books);

    EXPECT_EQ(after.row_of, books.row_of);
    EXPECT_EQ(after.shot.rows_kept, 2u);
}

TEST_P(ChooseShooter, NoRowIsKeptThatWasMadeWhenTheMemoryWasFull) {
    auto books = random_books(30, 1);
    books.pool = {1001, 1000};
    books.shot.row = 77;

    const auto after = closed(books);

    EXPECT_EQ(after.row_of, books.row_of);
    EXPECT_EQ(after.shot.rows_kept, 0u);
    EXPECT_EQ(after.shot.row, 0);
}

TEST_P(ChooseShooter, ANewRowBeginsWhereMemoryIsLeft) {
    auto books = random_books(30, 1);
    books.pool = {500, 500 + books.directory()};

    const auto after = closed(books);

    EXPECT_EQ(after.shot.row, 500);
    EXPECT_FALSE(after.shot.row_known);
    EXPECT_EQ(after.pool.taken, books.pool.size);
}

TEST_P(ChooseShooter, ANewRowHasNoPlaceWhereItsDirectoryDoesNotFit) {
    auto books = random_books(30, 1);
    books.pool = {500, 499 + books.directory()};

    const auto after = closed(books);

    EXPECT_EQ(after.shot.row, 0);
    EXPECT_FALSE(after.shot.row_known);
    EXPECT_EQ(after.pool.taken, 500u);
}

TEST_P(ChooseShooter, AShooterWhoseRowIsKnownNeedsNoHemisphere) {
    auto books = random_books(1, 1);
    books.pool = {500, 1000};
    books.row_of[32] = 123;

    const auto after = closed(books);

    EXPECT_TRUE(after.shot.row_known);
    EXPECT_EQ(after.shot.row, 123);
    EXPECT_EQ(after.pool.taken, 500u);
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
    books.shot.row = 123;
    books.row_escaped[std::size_t(books.shot.shooter)] = 0.25f;

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

// Whose most energetic shooters of 12 blocks are, from the first block on: 1, 0.96, 0.92, ...
Books salvo_books(std::uint32_t salvo) {
    auto books = random_books(12, 2);
    books.salvo = salvo;
    books.shot.part = books.shot.part_count;
    books.shot.most_shots = std::numeric_limits<std::uint32_t>::max();
    books.pool = {500, 1000};
    books.shot.row = 77;
    books.flux.assign(salvo * books.bands, 0.0f);
    device::Shot none{};
    none.shooter = -1;
    none.status = kRunning;
    none.row_known = none.part = none.part_count = 1;
    books.others.assign(2 * salvo - 1, none);
    for (std::size_t block = 0; block < books.summaries.size(); ++block)
        books.summaries[block].energy = 1 - 0.04f * static_cast<float>(block);
    return books;
}

std::int32_t shooter_of(std::size_t block) {
    return static_cast<std::int32_t>(block * kReduceBlock + 32);
}

std::vector<std::int32_t> shooters_of(const Books& books) {
    std::vector<std::int32_t> result{books.shot.shooter};
    for (const auto& shot : books.others)
        if (shot.shooter >= 0 && shot.is_ahead == 0) result.push_back(shot.shooter);
    return result;
}

std::vector<std::int32_t> looking_ahead(const Books& books) {
    std::vector<std::int32_t> result;
    for (const auto& shot : books.others)
        if (shot.shooter >= 0 && shot.is_ahead != 0) result.push_back(shot.shooter);
    return result;
}

TEST_P(ChooseShooter, ASalvoIsTheMostEnergeticShootersOfDifferentBlocks) {
    auto books = salvo_books(3);
    std::swap(books.summaries[1].energy, books.summaries[9].energy);

    const auto after = closed(books);

    EXPECT_EQ(shooters_of(after), (std::vector{shooter_of(0), shooter_of(9), shooter_of(2)}));
    for (std::size_t band = 0; band < 2; ++band)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(after.flux[i * 2 + band],
                      books.unshot[band * books.stride() + std::size_t(shooters_of(after)[i])]);
}

TEST_P(ChooseShooter, CrumbsAreLeftToGrow) {
    auto books = salvo_books(3);
    books.summaries[1].energy = 0.5f;
    for (std::size_t block = 2; block < 12; ++block) books.summaries[block].energy = 0.2f;

    const auto after = closed(books);

    EXPECT_EQ(shooters_of(after), (std::vector{shooter_of(0), shooter_of(1)}));
    EXPECT_TRUE(looking_ahead(after).empty());
    for (std::size_t member = 1; member < after.others.size(); ++member)
        EXPECT_GE(after.others[member].part, after.others[member].part_count);
}

// Two of three have looked, so that two of three stations are free.
TEST_P(ChooseShooter, WhereOneHasToLookOthersLookAhead) {
    auto books = salvo_books(3);
    books.shot.row_known = 1;
    books.row_of[std::size_t(shooter_of(0))] = 1;
    books.row_of[std::size_t(shooter_of(2))] = 2;
    books.row_of[std::size_t(shooter_of(3))] = 7;

    const auto after = closed(books);

    EXPECT_EQ(shooters_of(after), (std::vector{shooter_of(0), shooter_of(1), shooter_of(2)}));
    EXPECT_EQ(looking_ahead(after), (std::vector{shooter_of(4), shooter_of(5)}));
    const auto directory = static_cast<std::int32_t>(books.directory());
    EXPECT_EQ(after.others[0].row, 500);
    EXPECT_EQ(after.others[2].row, 500 + directory);
    EXPECT_EQ(after.others[3].row, 500 + 2 * directory);
    for (const auto& shot : {after.others[0], after.others[2], after.others[3]})
        EXPECT_LT(shot.part, shot.part_count);
}

TEST_P(ChooseShooter, NobodyLooksAheadWhereAllThatShootHaveLooked) {
    auto books = salvo_books(3);
    books.shot.row_known = 1;
    for (std::size_t block = 0; block < 3; ++block)
        books.row_of[std::size_t(shooter_of(block))] = std::int32_t(block) + 1;

    EXPECT_TRUE(looking_ahead(closed(books)).empty());
}

// Room for the rows of those that shoot, and not for one more.
TEST_P(ChooseShooter, NobodyLooksAheadForARowThatIsNotKept) {
    auto books = salvo_books(3);
    books.pool = {500, 500 + 2 * books.directory()};
    books.shot.row_known = 1;
    books.row_of[std::size_t(shooter_of(0))] = 1;

    const auto after = closed(books);

    EXPECT_TRUE(looking_ahead(after).empty());
    EXPECT_NE(after.others[0].row, 0);
    EXPECT_NE(after.others[1].row, 0);
    EXPECT_EQ(after.pool.taken, books.pool.size);
}

TEST_P(ChooseShooter, TheBooksOfAllThatShotAreClosed) {
    auto books = salvo_books(3);
    books.escaped_count = 40;
    books.owned_count = 300;
    books.flux = {0.5f, 0.25f, 0.125f, 1, 0, 0};
    books.row_escaped[70] = 0.5f;
    books.others[0].shooter = 70;  // known, and shoots
    books.others[0].row = 5;
    books.others[1] = books.shot;  // looks ahead
    books.others[1].shooter = 140;
    books.others[1].is_ahead = 1;
    books.others[1].row = 78;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, books.shot.shots + 2);
    EXPECT_EQ(after.shot.repeated_shots, 1u);
    EXPECT_EQ(after.shot.repeated_salvos, 0u);
    EXPECT_EQ(after.shot.rows_kept, 2u);
    EXPECT_EQ(after.row_of[3], 77);
    EXPECT_EQ(after.row_of[140], 78);
    EXPECT_EQ(after.row_of[70], 0);
    EXPECT_EQ(after.shot.least_surplus, 340 - 1000);
    const double part = 40.0f / (kDiskProxels * kParts);
    EXPECT_NEAR(double{after.escaped[0]} + after.escaped[2], 0.5 * part + 0.125 * 0.5, 1e-7);
    EXPECT_NEAR(double{after.escaped[1]} + after.escaped[3], 0.25 * part + 0.5, 1e-7);
    const std::size_t spare = books.stride() + kCountsGap;
    EXPECT_EQ(counts_[books.stride()], 0);
    EXPECT_EQ(counts_[spare + books.stride()], 0);
    EXPECT_EQ(counts_[2 * spare + books.stride()], 40);  // a station that nobody had
}

TEST_P(ChooseShooter, ShotsAreCountedOfThoseThatShootAndNotOfThoseThatLookAhead) {
    auto books = salvo_books(3);
    books.flux.assign(6, 0.5f);
    books.shots_of.assign(books.stride(), 0);
    books.shots_of[70] = 4;
    books.others[0].shooter = 70;
    books.others[1].shooter = 140;
    books.others[1].is_ahead = 1;

    const auto after = closed(books);

    auto expected = books.shots_of;
    expected[std::size_t(books.shot.shooter)] = 1;
    expected[70] = 5;
    EXPECT_EQ(after.shots_of, expected);
    EXPECT_EQ(after.shot.shots, books.shot.shots + 2);
}

TEST_P(ChooseShooter, ASalvoIsOfNoMoreThanAreAllowed) {
    auto books = salvo_books(3);
    books.shot.most_shots = books.shot.shots + 3;

    const auto after = closed(books);

    EXPECT_EQ(shooters_of(after), (std::vector{shooter_of(0), shooter_of(1)}));
}

TEST_P(ChooseShooter, OneThatHaltsHaltsItsSalvo) {
    auto books = salvo_books(3);
    books.others[2].status = kBinsFull;

    const auto after = closed(books);

    EXPECT_EQ(after.shot.shots, books.shot.shots);
    EXPECT_EQ(after.shot.shooter, books.shot.shooter);
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
}  // namespace hemirad::test::choose_shooter_test
