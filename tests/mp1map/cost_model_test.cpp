#include "mp1map/cost_model.h"

#include <gtest/gtest.h>

namespace mp1map::cost_model_test {
namespace {

constexpr Mp1 kPaper{};
constexpr Mp1 kLargest{.width = 128, .height = 128};

// 1,024 triangles, one a PE of the paper's machine, that touch `areas` areas each; the plane is of
// 1024 x 1024 proxels.
ShotCounts one_level(std::uint64_t areas, std::uint64_t plane_areas = 1024) {
    ShotCounts counts;
    counts.patches = counts.patches_visible = counts.patches_projected = 1024;
    counts.areas_visited = areas * 1024;
    counts.proxels_inside = areas * 1024 * 100;
    counts.plane_areas = plane_areas;
    return counts;
}

TEST(CostModel, DiffusesAThousandPatchesInThreeQuartersOfASecond) {
    EXPECT_NEAR(seconds(one_level(1), kPaper).diffusion, 0.75, 0.0075);
}

TEST(CostModel, DiffusionDoesNotDependOnTheArray) {
    for (const std::uint32_t size : {8u, 16u, 32u, 64u, 128u}) {
        const auto shot = seconds(one_level(1), {.width = size, .height = size});
        EXPECT_DOUBLE_EQ(shot.diffusion, seconds(one_level(1), kPaper).diffusion);
    }
}

TEST(CostModel, DiffusionGrowsWithBytes) {
    auto small = one_level(1);
    small.bytes_per_patch = 72;
    EXPECT_DOUBLE_EQ(seconds(small, kPaper).diffusion,
                     0.72 * seconds(one_level(1), kPaper).diffusion);
}

TEST(CostModel, AThousandPesDoSeventyFiveMegaflops) {
    EXPECT_DOUBLE_EQ(1024 / kPaper.seconds({.multiplications = 1}), 75e6);
    EXPECT_DOUBLE_EQ(1024 / kPaper.seconds({.additions = 1}), 75e6);
    EXPECT_DOUBLE_EQ(1024 / kPaper.seconds({.integers = 1}), 1600e6);
    EXPECT_NEAR(kPaper.float_operation / kPaper.clock, 164, 1);
}

TEST(CostModel, ATriangleTakesNineProductsAndSixSumsAProxel) {
    EXPECT_EQ(inside_test(3).multiplications, 9);
    EXPECT_EQ(inside_test(3).additions, 6);
    EXPECT_EQ(inside_test(4).multiplications, 12);
    EXPECT_EQ(distance_test().multiplications, 3);
    EXPECT_EQ(distance_test().additions, 2);
}

TEST(CostModel, SetUpAndCullAsCountedInTheDocs) {
    EXPECT_EQ(cull_patches(3), (Operations{12, 17, 0, 0, 9}));
    EXPECT_EQ(cull_patches(4), (Operations{15, 22, 0, 0, 11}));
    EXPECT_EQ(set_up_projection(3), (Operations{180, 166, 33, 23, 431}));
    EXPECT_EQ(set_up_projection(4), (Operations{226, 208, 41, 29, 539}));
}

TEST(CostModel, GuessesOfDivisionAndRootHardlyMatter) {
    Mp1 slow = kPaper;
    slow.division *= 10;
    slow.square_root *= 10;
    const auto guessed = seconds(one_level(4), kPaper).total();
    EXPECT_NEAR(seconds(one_level(4), slow).total() / guessed, 1, 0.02);
}

TEST(CostModel, TwiceTheAreasTakeTwiceTheInsideTests) {
    const Variant direct{.evaluation = Evaluation::direct};
    const auto once = seconds(one_level(2), kPaper, direct);
    const auto twice = seconds(one_level(4), kPaper, direct);
    EXPECT_DOUBLE_EQ(twice.inside_tests, 2 * once.inside_tests);
}

TEST(CostModel, TwiceThePatchesAndAreasTakeTwiceTheInsideTestsByDeltas) {
    auto counts = one_level(3);
    const auto once = seconds(counts, kPaper);
    counts.patches = counts.patches_visible = counts.patches_projected *= 2;
    counts.areas_visited *= 2;
    EXPECT_DOUBLE_EQ(seconds(counts, kPaper).inside_tests, 2 * once.inside_tests);
}

TEST(CostModel, DeltasSaveOnlyInFurtherAreas) {
    const Variant direct{.evaluation = Evaluation::direct};
    const Variant deltas_only{.evaluation = Evaluation::deltas_only};
    EXPECT_DOUBLE_EQ(seconds(one_level(1), kPaper).inside_tests,
                     seconds(one_level(1), kPaper, direct).inside_tests);
    EXPECT_LT(seconds(one_level(2), kPaper).inside_tests,
              seconds(one_level(2), kPaper, direct).inside_tests);
    EXPECT_LT(seconds(one_level(2), kPaper, deltas_only).inside_tests,
              seconds(one_level(2), kPaper).inside_tests);
}

// Sec. 1.6: "no more speedup could be obtain when the array size will be more important than the
// average bounding rectangle size".
TEST(CostModel, SixteenTimesThePesGainNothingWhereAPatchTouchesOneArea) {
    const auto small = seconds(one_level(1), kPaper), large = seconds(one_level(1, 64), kLargest);
    EXPECT_NEAR(small.projection() / large.projection(), 1, 2e-3);
    EXPECT_LT(speed_up(small, large), 1);
}

TEST(CostModel, SpeedUpGrowsWithTheAreasOfTheSmallArray) {
    const auto large = seconds(one_level(1, 64), kLargest);
    double before = 0;
    for (const std::uint64_t areas : {1u, 2u, 4u, 8u, 16u}) {
        const double gain = speed_up(seconds(one_level(areas), kPaper), large);
        EXPECT_GT(gain, before);
        EXPECT_LT(gain, 16);
        before = gain;
    }
}

TEST(CostModel, LevelsFollowFromTheArrayUnlessGiven) {
    auto counts = one_level(1);
    counts.patches = counts.patches_visible = counts.patches_projected = counts.areas_visited =
        2049;
    const double level = kPaper.seconds(set_up_projection(3));
    EXPECT_DOUBLE_EQ(seconds(counts, kPaper).set_up, 3 * level);
    EXPECT_DOUBLE_EQ(seconds(counts, kLargest).set_up, level);
    counts.levels = 5;
    EXPECT_DOUBLE_EQ(seconds(counts, kPaper).set_up, 5 * level);
}

TEST(CostModel, SearchingTheWholePlaneCostsTwoOperationsAProxelAndLevel) {
    const auto shot = seconds(one_level(4), kPaper, {.search = Search::whole_plane});
    const double travel = 1024 * 8 * kPaper.xnet_byte;
    EXPECT_NEAR(shot.accumulate, travel + 1024. * 1024 * 2 * kPaper.integer_operation, 1e-9);
    EXPECT_GT(shot.accumulate, seconds(one_level(4), kPaper).accumulate);
}

TEST(CostModel, TotalsAreSums) {
    const auto shot = seconds(one_level(4), kPaper);
    EXPECT_DOUBLE_EQ(shot.total(), shot.cull + shot.set_up + shot.diffusion + shot.inside_tests +
                                       shot.depth + shot.accumulate + shot.update + shot.choose);
    EXPECT_DOUBLE_EQ(diffusion_share(shot), shot.diffusion / shot.total());
    EXPECT_DOUBLE_EQ(speed_up(shot, shot), 1);
}

TEST(CostModel, EmptyShotTakesNoTime) {
    EXPECT_EQ(seconds({}, kPaper).total(), 0);
    EXPECT_EQ(useful_pes({}), 0);
}

TEST(CostModel, UsefulPesAreProxelsInsideAnArea) {
    EXPECT_DOUBLE_EQ(useful_pes(one_level(4)), 100);
}

TEST(CostModel, AreasTouchedByARectangle) {
    EXPECT_EQ(areas_touched({0, 31}, {0, 31}, 32, 32), 1u);
    EXPECT_EQ(areas_touched({31, 32}, {31, 32}, 32, 32), 4u);
    EXPECT_EQ(areas_touched({5, 5}, {0, 99}, 32, 8), 13u);
    EXPECT_EQ(areas_touched({1, 0}, {0, 31}, 32, 32), 0u);
    EXPECT_EQ(areas_touched({0, 31}, {7, 6}, 32, 32), 0u);
    EXPECT_EQ(areas_of_plane(1024, 32, 32), 1024u);
    EXPECT_EQ(areas_of_plane(52, 32, 32), 4u);
}

TEST(CostModel, PatchesThatTouchNoAreaAreDiffusedAllTheSame) {
    auto counts = one_level(0);
    counts.patches_projected = 0;
    const auto shot = seconds(counts, kPaper);
    EXPECT_NEAR(shot.diffusion, 0.75, 0.0075);
    EXPECT_EQ(shot.inside_tests, 0);
}

// The table at the end of docs/mp1-cost-model.md, in milliseconds.
TEST(CostModel, WorkedExampleOfTheDocs) {
    const auto small = seconds(one_level(4), kPaper), large = seconds(one_level(1, 64), kLargest);
    EXPECT_NEAR(small.set_up, 6.8e-3, 0.05e-3);
    EXPECT_NEAR(small.inside_tests, 595e-3, 0.5e-3);
    EXPECT_NEAR(small.depth, 205e-3, 0.5e-3);
    EXPECT_NEAR(small.accumulate, 17e-3, 0.5e-3);
    EXPECT_NEAR(small.total(), 1575e-3, 0.5e-3);
    EXPECT_NEAR(large.inside_tests, 212e-3, 0.5e-3);
    EXPECT_NEAR(large.depth, 72e-3, 0.5e-3);
    EXPECT_NEAR(large.accumulate, 213e-3, 0.5e-3);
    EXPECT_NEAR(large.total(), 1255e-3, 0.5e-3);
    EXPECT_NEAR(speed_up(small, large), 1.25, 0.01);
}

}  // namespace
}  // namespace mp1map::cost_model_test
