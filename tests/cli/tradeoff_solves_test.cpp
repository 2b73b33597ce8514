#include "cli/tradeoff_solves.h"

#include <gtest/gtest.h>

#include "tests/scene/scenes_by_hand.h"

namespace hemirad::tradeoff_solves_test {
namespace {

/// A lamp of a square metre that faces a floor at 0.3 m.
Scene lamp_over_floor() {
    Scene scene;
    scene.file = "lamp";
    scene.bands = {"grey"};
    scene.objects = {"floor", "lamp"};
    scene.materials = {{"white", {0.5}, {0}, false}, {"lamp", {0}, {1}, false}};
    add_face(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    add_face(scene, {{0, 0, .3}, {0, 1, .3}, {1, 1, .3}, {1, 0, .3}}, 1, 1);
    return scene;
}

constexpr std::uint32_t kResolution = 64;

SolvePoint point_of(std::uint32_t samples, double patch_scale) {
    return {Method::count, kResolution, samples, patch_scale};
}

class SolvesTest : public testing::Test {
  protected:
    Scene scene_ = lamp_over_floor();
    mp1map::Device device_ = mp1map::Device::open("");
    MeshSettings mesh_{.patch_size = 0.25, .backfaces = Backfaces::cull};
    Solves solves_{scene_, mesh_, point_of(2, 1), device_, [](const Progress&) { return true; }};
};

TEST_F(SolvesTest, HaveNoErrorAgainstThemselves) {
    const auto errors = solves_.measure(point_of(2, 1)).errors;

    EXPECT_EQ(errors.patches_rms, 0);
    EXPECT_EQ(errors.patches_largest, 0);
    EXPECT_EQ(errors.faces_rms, 0);
}

TEST_F(SolvesTest, OfCoarserPatchesAreOffByTheirMeansOverFaces) {
    const auto errors = solves_.measure(point_of(2, 2)).errors;

    EXPECT_EQ(errors.patches_rms, 0);
    EXPECT_GT(errors.faces_rms, 1e-3);
    EXPECT_LT(errors.faces_rms, 0.1);
}

TEST_F(SolvesTest, OfFewerPointsAreOffOnTheSamePatches) {
    const auto errors = solves_.measure(point_of(1, 1)).errors;

    EXPECT_GT(errors.patches_rms, 1e-3);
    EXPECT_GT(errors.patches_largest, errors.patches_rms);
}

TEST_F(SolvesTest, KnowAnalyticFromCountedFactors) {
    SolvePoint analytic = point_of(2, 1);
    analytic.method = Method::analytic;

    const auto errors = solves_.measure(analytic).errors;

    EXPECT_GT(errors.patches_rms, 1e-4);
    EXPECT_LT(errors.patches_rms, 0.1);
}

TEST_F(SolvesTest, CountPatchesAndProxels) {
    const auto measured = solves_.measure(point_of(2, 2));

    EXPECT_EQ(solves_.patch_count(1), 4 * solves_.patch_count(2));
    EXPECT_EQ(measured.samples,
              static_cast<double>(measured.shots * 4 * disk_proxel_count(kResolution)));
}

}  // namespace
}  // namespace hemirad::tradeoff_solves_test
