#include "extremes/solves_many_shots.h"
#include "extremes/solves_one_shot.h"

// Some ten seconds each.
namespace hemirad::test::solves_long_test {
namespace {

class LongExtremes : public testing::TestWithParam<FormFactorMode> {};

INSTANTIATE_TEST_SUITE_P(Modes, LongExtremes,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) { return name_of(mode.param); });

TEST_P(LongExtremes, AHundredThousandShotsCloseTheirBooks) {
    expect_closed_books(GetParam(), 100'000);
}

TEST_P(LongExtremes, TheFinestPlaneShowsTheSameFloor) {
    for (const std::uint32_t resolution : {4096u, 8191u, 8192u})
        expect_one_shot(lamp_above_floor(1, 1), one_shot(GetParam(), resolution));
}

// 843 million proxels, a quarter of what is refused.
TEST_P(LongExtremes, TheMostHemispheresOfAPlane) {
    expect_one_shot(lamp_above_floor(1, 1), one_shot(GetParam(), 512, 64));
}

TEST_P(LongExtremes, TwoMillionPatchesTakeTheirShot) {
    const Mesh mesh = lamp_above_floor(2000, 1000);
    ASSERT_EQ(mesh.patches.size(), 2'000'001u);
    expect_one_shot(mesh, one_shot(GetParam(), 512));
}

}  // namespace
}  // namespace hemirad::test::solves_long_test
