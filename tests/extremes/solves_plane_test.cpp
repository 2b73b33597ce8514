#include "errors.h"
#include "extremes/solves_one_shot.h"

// Planes from the coarsest to the finest, hemispheres and patches from one to many; what takes a
// minute is in solves_long_test.cpp, and two million patches in solves_soak_test.cpp.
namespace hemirad::test::solves_plane_test {
namespace {

class Plane : public testing::TestWithParam<FormFactorMode> {};

INSTANTIATE_TEST_SUITE_P(Modes, Plane,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) { return name_of(mode.param); });

TEST_P(Plane, OfAnyResolutionShowsTheSameFloor) {
    for (const std::uint32_t resolution : {16u, 17u, 1024u})
        expect_one_shot(lamp_above_floor(1, 1), one_shot(GetParam(), resolution));
}

// 64 x 64 hemispheres, 53 million proxels: more than a float counts one by one.
TEST_P(Plane, CountsBeyondTheIntegersOfAFloat) {
    ASSERT_GT(disk_proxel_count(128) * 64 * 64, 1u << 24);
    expect_one_shot(lamp_above_floor(1, 1), one_shot(GetParam(), 128, 64));
}

TEST_P(Plane, HoldsAsManyPatchesAsThereAreAndNoMore) {
    for (const int patches : {1, 62, 63, 64, 255, 256, 1023, 4095})  // and the lamp
        expect_one_shot(lamp_above_floor(patches, 1), one_shot(GetParam(), 64));
}

std::string refusal(std::uint32_t resolution, std::uint32_t samples) {
    const Mesh mesh = lamp_above_floor(1, 1);
    const auto device = mp1map::Device::open("");
    try {
        ProgressiveSolver(mesh, one_shot(FormFactorMode::count, resolution, samples), device);
    } catch (const InputError& fault) {
        return fault.what();
    }
    return {};
}

TEST(PlaneBeyondTheCounters, IsRefused) {
    EXPECT_EQ(refusal(1024, 64),
              "--resolution 1024 with --shooter-samples 64: 3373432832 proxels a shot; at most "
              "2147483647 can be counted");
    EXPECT_NE(refusal(8192, 7), "");
}

}  // namespace
}  // namespace hemirad::test::solves_plane_test
