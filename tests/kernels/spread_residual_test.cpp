#include <gtest/gtest.h>

#include "kernels/shared.h"
#include "support/kernel_run.h"

namespace hemirad::test::spread_residual_test {
namespace {

constexpr std::int32_t kDisk = 1000, kStride = 2 * kReduceBlock;
constexpr float kParts = 4;

struct Row {
    float visible, doubtful;   // sums over all patches, a hemisphere
    std::int32_t escaped = 0;  // proxels of all hemispheres
};

class SpreadResidual : public testing::TestWithParam<std::uint32_t> {
  protected:
    device::Shot closed(const Row& row) {
        KernelOptions options;
        options.reduce_pes = GetParam();
        KernelRun run("spread_residual", options);
        device::Shot shot{};
        shot.status = kRunning;
        shot.part = shot.part_count = static_cast<std::uint32_t>(kParts);
        auto plural = run.plural(std::vector{shot});
        std::vector<std::int32_t> counts(kStride + kSpareCounts, 0);
        counts[kStride] = row.escaped;
        const float v = kParts * row.visible, d = kParts * row.doubtful;
        run.issue({1, GetParam()}, plural,
                  run.plural(std::vector<float>{0.25f * v, 0.75f * d, 0.75f * v, 0.25f * d}),
                  std::int32_t(2), run.plural(counts), kStride, kDisk);
        return run.acu().unload(plural).front();
    }
    // What the row adds up to after update_radiosity.
    static float sum(const Row& row, const device::Shot& shot) {
        return kParts * (row.visible * shot.factor_scale + row.doubtful * shot.residual_share) +
               shot.escaped_fraction;
    }
};

INSTANTIATE_TEST_SUITE_P(Pes, SpreadResidual, testing::Values(1u, 3u, 64u));

TEST_P(SpreadResidual, GoesToWhatIsInDoubt) {
    const Row row{0.97f, 0.1f};

    const auto shot = closed(row);

    EXPECT_EQ(shot.factor_scale, 1 / kParts);
    EXPECT_NEAR(shot.residual_share, 0.03 / 0.1 / kParts, 1e-6);
    EXPECT_NEAR(sum(row, shot), 1, 3e-7);
}

TEST_P(SpreadResidual, GoesToTheOutsideWhereNothingElseIsInDoubt) {
    const Row row{0.7f, 0, static_cast<std::int32_t>(0.28f * kDisk * kParts)};

    const auto shot = closed(row);

    EXPECT_EQ(shot.factor_scale, 1 / kParts);
    EXPECT_NEAR(shot.escaped_fraction, 0.3, 1e-6);
}

TEST_P(SpreadResidual, ScalesAllWhereTheDoubtIsLessThanWhatLacks) {
    const Row row{0.9f, 0.01f};

    const auto shot = closed(row);

    EXPECT_NEAR(shot.factor_scale, 1 / 0.9 / kParts, 1e-6);
    EXPECT_EQ(shot.residual_share, 0);
    EXPECT_NEAR(sum(row, shot), 1, 3e-7);
}

TEST_P(SpreadResidual, ARowThatSeesNothingStaysFinite) {
    const auto shot = closed({0, 0});

    EXPECT_EQ(shot.factor_scale, 1 / kParts);
    EXPECT_EQ(shot.escaped_fraction, 0);
}

}  // namespace
}  // namespace hemirad::test::spread_residual_test
