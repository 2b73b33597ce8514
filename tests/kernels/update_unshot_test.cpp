#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "support/kernel_run.h"
#include "support/pipeline.h"

namespace hemirad::test::update_unshot_test {
namespace {

constexpr std::uint32_t kShooters = 4 * kReduceBlock, kStride = 6 * kReduceBlock;
constexpr std::int32_t kShooter = 77;
constexpr std::size_t kSums = 16;  // of a block, so that lanes do not change their order

struct State {
    std::size_t bands = 1;
    std::vector<float> shot_flux, weight;    // [band]
    std::vector<float> unshot, reflectance;  // [band][patch]
    std::vector<float> rows;                 // [member][patch], of the shot
    std::vector<std::int32_t> first_patch;   // [shooter], and one more; empty: one level
    std::int32_t shooter = kShooter, status = kRunning;
    std::uint32_t part = 4;
};

struct Outcome {
    std::vector<float> unshot;
    std::vector<device::BlockSummary> summaries;
    std::vector<float> block_unshot;  // [block][band]
};

State random_state(std::size_t bands) {
    std::mt19937 random(61);
    std::uniform_real_distribution<float> unit(0, 1);
    State state;
    state.bands = bands;
    for (std::size_t band = 0; band < bands; ++band) {
        state.shot_flux.push_back(unit(random));
        state.weight.push_back(band == 1 ? 0.0f : unit(random));
    }
    for (std::size_t i = 0; i < bands * kShooters; ++i) {
        state.unshot.push_back(unit(random));
        state.reflectance.push_back(unit(random));
    }
    for (std::uint32_t i = 0; i < 3 * kStride; ++i) state.rows.push_back(unit(random));
    return state;
}

// The reflected part of what the row brings goes to what is unshot, of which the shooter has none.
float form_factor_to(const State& state, std::size_t shooter) {
    const float* const row = state.rows.data();
    if (state.first_patch.empty()) return row[shooter];
    std::array<float, kSums> sums{};
    for (int i = state.first_patch[shooter]; i < state.first_patch[shooter + 1]; ++i)
        sums[(i - state.first_patch[shooter]) % kSums] += row[i];
    float total = 0;
    for (const float sum : sums) total += sum;
    return total;
}

std::vector<float> expected_unshot(const State& state) {
    auto unshot = state.unshot;
    for (std::size_t band = 0; band < state.bands; ++band)
        for (std::size_t shooter = 0; shooter < kShooters; ++shooter) {
            const std::size_t at = band * kShooters + shooter;
            const float flux = form_factor_to(state, shooter) * state.shot_flux[band];
            const bool is_shooter = static_cast<std::int32_t>(shooter) == state.shooter;
            unshot[at] = std::fma(state.reflectance[at], flux, is_shooter ? 0.0f : unshot[at]);
        }
    return unshot;
}

device::BlockSummary summary_of(const State& state, const std::vector<float>& unshot,
                                std::size_t first) {
    device::BlockSummary summary{-1, 0};
    for (std::size_t patch = first; patch < first + kReduceBlock; ++patch) {
        float energy = 0;
        for (std::size_t band = 0; band < state.bands; ++band)
            energy = std::fma(state.weight[band], unshot[band * kShooters + patch], energy);
        if (energy > summary.energy) summary = {energy, static_cast<std::int32_t>(patch)};
    }
    return summary;
}

float sum_of(const std::vector<float>& unshot, std::size_t band, std::size_t first) {
    std::array<float, kSums> sums{};
    for (std::size_t k = 0; k < kReduceBlock; ++k)
        sums[k % kSums] += unshot[band * kShooters + first + k];
    float total = 0;
    for (const float sum : sums) total += sum;
    return total;
}

Outcome expected_outcome(const State& state) {
    Outcome outcome{expected_unshot(state), {}, {}};
    for (std::size_t first = 0; first < kShooters; first += kReduceBlock) {
        outcome.summaries.push_back(summary_of(state, outcome.unshot, first));
        for (std::size_t band = 0; band < state.bands; ++band)
            outcome.block_unshot.push_back(sum_of(outcome.unshot, band, first));
    }
    return outcome;
}

Outcome updated(const State& state, const Shape& shape) {
    KernelOptions options;
    options.lanes = shape.lanes;
    options.bands = static_cast<std::uint32_t>(state.bands);
    options.two_levels = !state.first_patch.empty();
    KernelRun run("update_unshot", options);
    device::Shot shot{};
    shot.shooter = state.shooter;
    shot.status = state.status;
    shot.part = state.part;
    shot.part_count = 4;
    auto unshot = run.plural(state.unshot);
    auto summaries = run.acu().plural<device::BlockSummary>(kShooters / kReduceBlock);
    auto block_unshot = run.acu().plural<float>(kShooters / kReduceBlock * state.bands);
    run.issue(run.fitting({2, std::size_t{shape.width} * shape.height}),
              run.plural(std::vector{shot}), run.plural(state.shot_flux), run.plural(state.rows),
              std::int32_t(kStride), run.plural(state.first_patch), std::int32_t(kShooters), unshot,
              run.plural(state.reflectance), run.plural(state.weight), summaries, block_unshot);
    return {run.acu().unload(unshot), run.acu().unload(summaries), run.acu().unload(block_unshot)};
}

void expect_equal(const Outcome& outcome, const Outcome& expected) {
    EXPECT_EQ(bits(outcome.unshot), bits(expected.unshot));
    EXPECT_EQ(bits(outcome.block_unshot), bits(expected.block_unshot));
    ASSERT_EQ(outcome.summaries.size(), expected.summaries.size());
    for (std::size_t block = 0; block < outcome.summaries.size(); ++block) {
        EXPECT_EQ(outcome.summaries[block].energy, expected.summaries[block].energy);
        EXPECT_EQ(outcome.summaries[block].shooter, expected.summaries[block].shooter);
    }
}

class UpdateUnshot : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, UpdateUnshot, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(UpdateUnshot, AGreyShotHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(1);

    expect_equal(updated(state, GetParam()), expected_outcome(state));
}

TEST_P(UpdateUnshot, AShotOfThreeBandsHasTheBitsOfTheScalarComputation) {
    const auto state = random_state(3);

    expect_equal(updated(state, GetParam()), expected_outcome(state));
}

// 300 patches: of the first shooter 40, of the others 2 or 3 as it falls.
TEST_P(UpdateUnshot, AShooterReflectsWhatItsElementsReceived) {
    auto state = random_state(3);
    state.first_patch = {0, 40};
    while (state.first_patch.back() < 300)
        state.first_patch.push_back(state.first_patch.back() +
                                    (state.first_patch.size() % 3 == 0 ? 3 : 2));
    state.first_patch.resize(kShooters + 1, state.first_patch.back());

    expect_equal(updated(state, GetParam()), expected_outcome(state));
}

// Two of one block and one of another shoot, and keep what the others send them; one looks ahead.
TEST_P(UpdateUnshot, OfASalvoEachHasShotWhatItHad) {
    constexpr std::array<std::size_t, 4> kMembers{77, 80, 200, 90};
    const auto state = random_state(1);
    KernelOptions options;
    options.lanes = GetParam().lanes;
    options.salvo = 4;
    KernelRun run("update_unshot", options);
    std::vector<device::Shot> salvo(8);
    for (std::size_t member = 0; member < salvo.size(); ++member) {
        salvo[member].status = kRunning;
        salvo[member].part = salvo[member].part_count = 1;
        salvo[member].shooter = member < 4 ? std::int32_t(kMembers[member]) : -1;
    }
    salvo[3].is_ahead = 1;
    const std::vector<float> flux{0.5f, 0.25f, 0.125f, 9, 0, 0, 0, 0};
    auto unshot = run.plural(state.unshot);
    auto summaries = run.acu().plural<device::BlockSummary>(kShooters / kReduceBlock);
    auto block_unshot = run.acu().plural<float>(kShooters / kReduceBlock);

    run.issue(run.fitting({2, std::size_t{GetParam().width} * GetParam().height}),
              run.plural(salvo), run.plural(flux), run.plural(state.rows), std::int32_t(kStride),
              run.plural(state.first_patch), std::int32_t(kShooters), unshot,
              run.plural(state.reflectance), run.plural(state.weight), summaries, block_unshot);

    const auto left = run.acu().unload(unshot);
    for (std::size_t shooter = 0; shooter < kShooters; ++shooter) {
        double sent = 0;
        for (std::size_t member = 0; member < 3; ++member)
            sent += double{flux[member]} * state.rows[member * kStride + shooter];
        const bool has_shot = shooter == 77 || shooter == 80 || shooter == 200;
        EXPECT_NEAR(left[shooter],
                    (has_shot ? 0 : state.unshot[shooter]) + state.reflectance[shooter] * sent,
                    2e-7);
    }
}

TEST_P(UpdateUnshot, EquallyEnergeticPatchesLeaveTheChoiceToTheLowest) {
    auto state = random_state(1);
    state.shooter = -1;
    state.weight = {1};
    state.rows.assign(state.rows.size(), 0.0f);
    state.unshot.assign(kShooters, 0.25f);
    state.unshot[70] = state.unshot[75] = state.unshot[127] = 0.5f;

    const auto summaries = updated(state, GetParam()).summaries;

    const std::vector<std::int32_t> chosen = {0, 70, 128, 192};
    for (std::size_t block = 0; block < chosen.size(); ++block)
        EXPECT_EQ(summaries[block].shooter, chosen[block]);
}

TEST_P(UpdateUnshot, TheShooterKeepsOnlyWhatItSendsToItself) {
    auto state = random_state(1);
    state.rows[kShooter] = 0;

    EXPECT_EQ(updated(state, GetParam()).unshot[kShooter], 0.0f);
}

TEST_P(UpdateUnshot, AHaltedShotChangesNothing) {
    auto state = random_state(1);
    state.status = kBinsFull;

    EXPECT_EQ(bits(updated(state, GetParam()).unshot), bits(state.unshot));
}

TEST_P(UpdateUnshot, NothingChangesBeforeTheShootersLastHemisphere) {
    auto state = random_state(1);
    state.part = 3;

    EXPECT_EQ(bits(updated(state, GetParam()).unshot), bits(state.unshot));
}

}  // namespace
}  // namespace hemirad::test::update_unshot_test
