#include <gtest/gtest.h>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test::correct_near_pairs_test {
namespace {

constexpr std::int32_t kPatches = 64;

// Patch 1 is near to 3 and 5, from four hemispheres that saw 0.4 and nothing of them.
class CorrectNearPairs : public testing::TestWithParam<std::uint32_t> {
  protected:
    std::vector<float> corrected(std::uint32_t part) {
        KernelRun run("correct_near_pairs", {});
        device::Shot shot{};
        shot.status = kRunning;
        shot.shooter = 1;
        shot.part = part;
        shot.part_count = 4;
        std::vector<float> factors(kFactorKinds * kPatches, 0.5f);
        factors[kVisibleFactor * kPatches + 3] = 0.2f;
        factors[kUnblockedFactor * kPatches + 3] = 0.4f;
        factors[kDoubtfulFactor * kPatches + 3] = 0.1f;
        for (int kind = 0; kind < kFactorKinds; ++kind) factors[kind * kPatches + 5] = 0;
        auto plural = run.plural(factors);
        std::vector<std::int32_t> begin(kPatches + 1, 3);
        begin[0] = 0;
        begin[1] = 1;
        run.issue({1, GetParam()}, run.plural(std::vector{shot}), run.plural(begin),
                  run.plural(std::vector<std::int32_t>{2, 3, 5}),
                  run.plural(std::vector<float>{9, 0.3f, 0.3f}), kPatches, plural);
        return run.acu().unload(plural);
    }
};

INSTANTIATE_TEST_SUITE_P(Pes, CorrectNearPairs, testing::Values(1u, 2u, 64u));

TEST_P(CorrectNearPairs, TheVisibleFractionOfTheClosedFormRemains) {
    const auto factors = corrected(4);

    // Half of it is seen: of 0.3, and that over four hemispheres.
    EXPECT_NEAR(factors[kVisibleFactor * kPatches + 3], 4 * 0.3 / 2, 1e-6);
    EXPECT_NEAR(factors[kDoubtfulFactor * kPatches + 3], 4 * 0.3 / 4, 1e-6);
    EXPECT_EQ(factors[kVisibleFactor * kPatches + 5], 0);
    EXPECT_EQ(factors[kVisibleFactor * kPatches + 2], 0.5f);  // another shooter's
}

TEST_P(CorrectNearPairs, NothingChangesBeforeTheLastHemisphere) {
    EXPECT_EQ(corrected(3)[kVisibleFactor * kPatches + 3], 0.2f);
}

}  // namespace
}  // namespace hemirad::test::correct_near_pairs_test
