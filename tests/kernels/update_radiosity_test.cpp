#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/kept_rows.h"
#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test::update_radiosity_test {
namespace {

constexpr std::uint32_t kStride = 4 * kReduceBlock;
constexpr std::uint32_t kUnits = 1 << 17;  // for rows, more than any shape takes

// What a scene's patches have received, [band * kStride + patch], and what a shot brings.
struct State {
    std::size_t bands = 1;
    std::vector<float> shot_flux, received, rest;
    std::vector<std::int32_t> counts;  // and kSpareCounts more
    std::vector<float> row;            // of the shooter: known, or that of the shot
    std::vector<float> kept;           // what is kept of it; empty: nothing
    std::int32_t status = kRunning;
    bool is_known = false, is_to_be_kept = true;
    std::int32_t disk_proxels = 3209;
    std::uint32_t part = 4, part_count = 4;
};

State random_state(std::size_t bands) {
    std::mt19937 random(60);
    std::uniform_real_distribution<float> unit(0, 1);
    State state;
    state.bands = bands;
    for (std::size_t band = 0; band < bands; ++band) state.shot_flux.push_back(unit(random));
    for (std::size_t i = 0; i < bands * kStride; ++i) {
        state.received.push_back(100 * unit(random));
        state.rest.push_back(1e-6f * unit(random));
    }
    for (std::uint32_t patch = 0; patch < kStride; ++patch)
        state.counts.push_back(random() % 4 == 0 ? static_cast<std::int32_t>(random() % 300) : 0);
    state.counts.resize(kStride + kSpareCounts);
    for (std::uint32_t i = 0; i < kStride; ++i)
        state.row.push_back(random() % 4 == 0 ? unit(random) : 0.0f);
    return state;
}

// One patch of one band: Knuth's two-sum of the flux.
void add_flux(State& state, std::size_t band, std::size_t patch) {
    const std::size_t at = band * kStride + patch;
    const float flux = state.row[patch] * state.shot_flux[band];
    const float increment = flux + state.rest[at];
    const float total = state.received[at] + increment;
    const float part = total - state.received[at];
    state.rest[at] = (state.received[at] - (total - part)) + (increment - part);
    state.received[at] = total;
}

// Form factors go from the counts to the row, unless it is known, and the flux goes by the row.
State expected_state(State state) {
    if (!state.is_known)
        for (std::size_t patch = 0; patch < kStride; ++patch) {
            state.row[patch] = static_cast<float>(state.counts[patch]) /
                               static_cast<float>(state.disk_proxels * state.part_count);
            state.counts[kStride + 2] += state.counts[patch];
            state.counts[patch] = 0;
        }
    for (std::size_t band = 0; band < state.bands; ++band)
        for (std::size_t patch = 0; patch < kStride; ++patch) add_flux(state, band, patch);
    if (state.is_known || state.is_to_be_kept) state.kept = state.row;
    return state;
}

std::size_t pe_count(const Shape& shape) { return 2 * std::size_t{shape.width} * shape.height; }

State updated(State state, const Shape& shape) {
    KeptRows kept(kUnits, kStride, pe_count(shape));
    const std::int32_t place = state.is_known        ? kept.keep(state.row)
                               : state.is_to_be_kept ? kept.promise()
                                                     : 0;
    KernelOptions options;
    options.lanes = shape.lanes;
    options.bands = static_cast<std::uint32_t>(state.bands);
    KernelRun run("update_radiosity", options);
    device::Shot shot{};
    shot.status = state.status;
    shot.part = state.part;
    shot.part_count = state.part_count;
    shot.row = place;
    shot.row_known = state.is_known;
    auto counts = run.plural(state.counts);
    auto received = run.plural(state.received), rest = run.plural(state.rest);
    auto row = run.plural(state.row);
    auto words = run.plural(kept.words);
    auto pool = run.plural(kept.pool);
    run.issue(run.fitting({2, std::size_t{shape.width} * shape.height}),
              run.plural(std::vector{shot}), run.plural(state.shot_flux), counts,
              state.disk_proxels, run.acu().plural<float>(1), std::int32_t(kStride), words, pool,
              run.plural(kept.extents), row, received, rest);
    state.counts = run.acu().unload(counts);
    state.received = run.acu().unload(received);
    state.rest = run.acu().unload(rest);
    state.row = run.acu().unload(row);
    kept.words = run.acu().unload(words);
    kept.pool = run.acu().unload(pool);
    EXPECT_FALSE(kept.is_full());
    if (place != 0) state.kept = kept.row(place);
    return state;
}

void expect_equal(const State& state, const State& expected) {
    EXPECT_EQ(bits(state.received), bits(expected.received));
    EXPECT_EQ(bits(state.rest), bits(expected.rest));
    EXPECT_EQ(bits(state.row), bits(expected.row));
    EXPECT_EQ(bits(state.kept), bits(expected.kept));
    EXPECT_EQ(state.counts, expected.counts);
}

class UpdateRadiosity : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, UpdateRadiosity, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(UpdateRadiosity, AGreyShotHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(1);

    expect_equal(updated(state, GetParam()), expected_state(state));
}

TEST_P(UpdateRadiosity, AShotOfThreeBandsHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(3);

    expect_equal(updated(state, GetParam()), expected_state(state));
}

TEST_P(UpdateRadiosity, AKnownRowIsTakenAsItIs) {
    auto state = random_state(3);
    state.is_known = true;

    expect_equal(updated(state, GetParam()), expected_state(state));
}

TEST_P(UpdateRadiosity, ARowWithoutAPlaceIsNotKept) {
    auto state = random_state(1);
    state.is_to_be_kept = false;

    expect_equal(updated(state, GetParam()), expected_state(state));
}

// One by a known row, one that has looked, and one that looked ahead: it keeps its row and sends
// nothing. Whoever has looked has counts, one behind the other.
TEST_P(UpdateRadiosity, OfASalvoEachSendsItsFluxByItsRow) {
    constexpr std::size_t kCounts = kStride + kCountsGap;
    const auto state = random_state(1);
    KernelOptions options;
    options.lanes = GetParam().lanes;
    options.salvo = 2;
    KernelRun run("update_radiosity", options);
    std::vector<device::Shot> salvo(4);
    for (auto& shot : salvo) {
        shot.status = kRunning;
        shot.part = shot.part_count = 1;
    }
    KeptRows kept(kUnits, kStride, pe_count(GetParam()));
    salvo[0].row = kept.keep(state.row);
    salvo[0].row_known = 1;
    salvo[1].row = kept.promise();
    salvo[2].row = kept.promise();
    salvo[2].is_ahead = 1;
    salvo[3].shooter = -1;
    std::vector<std::int32_t> counts(2 * kCounts);
    std::copy_n(state.counts.begin(), kStride, counts.begin());
    std::copy_n(state.counts.rbegin() + kSpareCounts, kStride, counts.begin() + kCounts);
    const std::vector<float> flux{0.5f, 0.3f, 0, 0};
    auto on_device = run.plural(counts);
    auto received = run.plural(state.received), rest = run.plural(state.rest);
    auto shot_rows = run.acu().plural<float>(3 * kStride);
    auto words = run.plural(kept.words);

    run.issue(run.fitting({2, std::size_t{GetParam().width} * GetParam().height}),
              run.plural(salvo), run.plural(flux), on_device, state.disk_proxels,
              run.acu().plural<float>(1), std::int32_t(kStride), words, run.plural(kept.pool),
              run.plural(kept.extents), shot_rows, received, rest);

    kept.words = run.acu().unload(words);
    const auto looked = kept.row(salvo[1].row), ahead = kept.row(salvo[2].row);
    const auto of_shot = run.acu().unload(shot_rows);
    const auto sums = run.acu().unload(received), rests = run.acu().unload(rest);
    const auto counted = run.acu().unload(on_device);
    const auto disk = static_cast<float>(state.disk_proxels);
    for (std::size_t patch = 0; patch < kStride; ++patch) {
        const auto first = static_cast<float>(counts[patch]) / disk;
        EXPECT_EQ(looked[patch], first);
        EXPECT_EQ(ahead[patch], static_cast<float>(counts[kCounts + patch]) / disk);
        EXPECT_EQ(of_shot[patch], state.row[patch]);
        EXPECT_EQ(of_shot[kStride + patch], first);
        const float sent = std::fma(first, flux[1], state.row[patch] * flux[0]);
        // Two-sum is exact but for the increment's rounding.
        EXPECT_EQ(double{sums[patch]} + rests[patch],
                  double{state.received[patch]} + (sent + state.rest[patch]));
        EXPECT_EQ(counted[patch], 0);
        EXPECT_EQ(counted[kCounts + patch], 0);
    }
    EXPECT_GT(counted[kStride + 2], 0);
    EXPECT_GT(counted[kCounts + kStride + 2], 0);
}

TEST_P(UpdateRadiosity, AHaltedShotChangesNothing) {
    auto state = random_state(1);
    state.status = kBinsFull;
    state.is_to_be_kept = false;

    expect_equal(updated(state, GetParam()), state);
}

TEST_P(UpdateRadiosity, NothingChangesBeforeTheShootersLastHemisphere) {
    auto state = random_state(1);
    state.part = 3;
    state.is_to_be_kept = false;

    expect_equal(updated(state, GetParam()), state);
}

}  // namespace
}  // namespace hemirad::test::update_radiosity_test
