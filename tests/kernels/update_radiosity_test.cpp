#include <gtest/gtest.h>

#include <random>

#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test {
namespace {

constexpr std::uint32_t kStride = 4 * kReduceBlock;
constexpr std::size_t kSums = 16;  // of a block, so that lanes do not change their order

// The radiosity state of a scene, [band * kStride + patch], and what a shot brings.
struct State {
    std::size_t bands = 1;
    std::vector<float> shot_flux, received, rest, unshot, reflectance, weight;
    std::vector<std::int32_t> counts;
    std::int32_t shooter = 0, status = kRunning;
    std::int32_t disk_proxels = 3209;
    std::uint32_t part = 4, part_count = 4;
};

struct Outcome {
    State state;
    std::vector<device::BlockSummary> summaries;
    std::vector<float> block_unshot;  // [block][band]
};

State random_state(std::size_t bands) {
    std::mt19937 random(60);
    std::uniform_real_distribution<float> unit(0, 1);
    State state;
    state.bands = bands;
    for (std::size_t band = 0; band < bands; ++band) {
        state.shot_flux.push_back(unit(random));
        state.weight.push_back(band == 1 ? 0.0f : unit(random));
    }
    for (std::size_t i = 0; i < bands * kStride; ++i) {
        state.received.push_back(100 * unit(random));
        state.rest.push_back(1e-6f * unit(random));
        state.unshot.push_back(unit(random));
        state.reflectance.push_back(unit(random));
    }
    for (std::uint32_t patch = 0; patch < kStride; ++patch)
        state.counts.push_back(random() % 4 == 0 ? static_cast<std::int32_t>(random() % 300) : 0);
    state.shooter = 77;
    return state;
}

// One patch of one band, in the order of the kernel's docstring: Knuth's two-sum of the flux, then
// the reflected part to what is unshot, of which the shooter has none left.
void add_flux(State& state, std::size_t band, std::size_t patch) {
    const std::size_t at = band * kStride + patch;
    const float flux = static_cast<float>(state.counts[patch]) /
                       static_cast<float>(state.disk_proxels * state.part_count) *
                       state.shot_flux[band];
    const float increment = flux + state.rest[at];
    const float total = state.received[at] + increment;
    const float part = total - state.received[at];
    state.rest[at] = (state.received[at] - (total - part)) + (increment - part);
    state.received[at] = total;
    const bool is_shooter = static_cast<std::int32_t>(patch) == state.shooter;
    state.unshot[at] = std::fma(state.reflectance[at], flux, is_shooter ? 0.0f : state.unshot[at]);
}

device::BlockSummary summary_of(const State& state, std::size_t first) {
    device::BlockSummary summary{-1, 0, 0};
    for (std::size_t patch = first; patch < first + kReduceBlock; ++patch) {
        summary.proxels += static_cast<std::uint32_t>(state.counts[patch]);
        float energy = 0;
        for (std::size_t band = 0; band < state.bands; ++band)
            energy = std::fma(state.weight[band], state.unshot[band * kStride + patch], energy);
        if (energy <= summary.energy) continue;
        summary.energy = energy;
        summary.patch = static_cast<std::int32_t>(patch);
    }
    return summary;
}

float unshot_of(const State& state, std::size_t band, std::size_t first) {
    std::array<float, kSums> sums{};
    for (std::size_t k = 0; k < kReduceBlock; ++k)
        sums[k % kSums] += state.unshot[band * kStride + first + k];
    float total = 0;
    for (const float sum : sums) total += sum;
    return total;
}

Outcome expected_outcome(State state) {
    for (std::size_t band = 0; band < state.bands; ++band)
        for (std::size_t patch = 0; patch < kStride; ++patch) add_flux(state, band, patch);
    Outcome outcome;
    for (std::size_t first = 0; first < kStride; first += kReduceBlock) {
        outcome.summaries.push_back(summary_of(state, first));
        for (std::size_t band = 0; band < state.bands; ++band)
            outcome.block_unshot.push_back(unshot_of(state, band, first));
    }
    state.counts.assign(kStride, 0);
    outcome.state = state;
    return outcome;
}

Outcome updated(const State& state, const Shape& shape) {
    KernelOptions options;
    options.lanes = shape.lanes;
    options.bands = static_cast<std::uint32_t>(state.bands);
    KernelRun run("update_radiosity", options);
    device::Shot shot{};
    shot.patch = state.shooter;
    shot.status = state.status;
    shot.part = state.part;
    shot.part_count = state.part_count;
    auto counts = run.plural(state.counts);
    auto received = run.plural(state.received), rest = run.plural(state.rest);
    auto unshot = run.plural(state.unshot);
    auto summaries = run.acu().plural<device::BlockSummary>(kStride / kReduceBlock);
    auto block_unshot = run.acu().plural<float>(kStride / kReduceBlock * state.bands);
    run.issue({2, std::size_t{shape.width} * shape.height}, run.plural(std::vector{shot}),
              run.plural(state.shot_flux), counts, state.disk_proxels, run.acu().plural<float>(1),
              std::int32_t(kStride), received, rest, unshot, run.plural(state.reflectance),
              run.plural(state.weight), summaries, block_unshot);
    Outcome outcome{state, run.acu().unload(summaries), run.acu().unload(block_unshot)};
    outcome.state.counts = run.acu().unload(counts);
    outcome.state.received = run.acu().unload(received);
    outcome.state.rest = run.acu().unload(rest);
    outcome.state.unshot = run.acu().unload(unshot);
    return outcome;
}

void expect_equal(const Outcome& outcome, const Outcome& expected) {
    EXPECT_EQ(bits(outcome.state.received), bits(expected.state.received));
    EXPECT_EQ(bits(outcome.state.rest), bits(expected.state.rest));
    EXPECT_EQ(bits(outcome.state.unshot), bits(expected.state.unshot));
    EXPECT_EQ(outcome.state.counts, expected.state.counts);
    EXPECT_EQ(bits(outcome.block_unshot), bits(expected.block_unshot));
    ASSERT_EQ(outcome.summaries.size(), expected.summaries.size());
    for (std::size_t block = 0; block < outcome.summaries.size(); ++block) {
        EXPECT_EQ(outcome.summaries[block].energy, expected.summaries[block].energy);
        EXPECT_EQ(outcome.summaries[block].patch, expected.summaries[block].patch);
        EXPECT_EQ(outcome.summaries[block].proxels, expected.summaries[block].proxels);
    }
}

class UpdateRadiosity : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, UpdateRadiosity, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(UpdateRadiosity, AGreyShotHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(1);

    expect_equal(updated(state, GetParam()), expected_outcome(state));
}

TEST_P(UpdateRadiosity, AShotOfThreeBandsHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(3);

    expect_equal(updated(state, GetParam()), expected_outcome(state));
}

TEST_P(UpdateRadiosity, EquallyEnergeticPatchesLeaveTheChoiceToTheLowest) {
    auto state = random_state(1);
    state.shooter = -1;
    state.weight = {1};
    state.counts.assign(kStride, 0);
    state.unshot.assign(kStride, 0.25f);
    state.unshot[70] = state.unshot[75] = state.unshot[127] = 0.5f;

    const auto summaries = updated(state, GetParam()).summaries;

    const std::vector<std::int32_t> chosen = {0, 70, 128, 192};
    for (std::size_t block = 0; block < chosen.size(); ++block)
        EXPECT_EQ(summaries[block].patch, chosen[block]);
}

TEST_P(UpdateRadiosity, TheShooterKeepsOnlyWhatItSendsToItself) {
    auto state = random_state(1);
    state.counts[77] = 0;

    EXPECT_EQ(updated(state, GetParam()).state.unshot[77], 0.0f);
}

void expect_unchanged(const State& state, const Shape& shape) {
    const auto outcome = updated(state, shape);

    EXPECT_EQ(bits(outcome.state.received), bits(state.received));
    EXPECT_EQ(bits(outcome.state.unshot), bits(state.unshot));
    EXPECT_EQ(outcome.state.counts, state.counts);
}

TEST_P(UpdateRadiosity, AHaltedShotChangesNothing) {
    auto state = random_state(1);
    state.status = kBinsFull;

    expect_unchanged(state, GetParam());
}

TEST_P(UpdateRadiosity, NothingChangesBeforeTheShootersLastHemisphere) {
    auto state = random_state(1);
    state.part = 3;

    expect_unchanged(state, GetParam());
}

}  // namespace
}  // namespace hemirad::test
