#include "mp1map/cost_model.h"

#include <gtest/gtest.h>

namespace mp1map {
namespace {

constexpr Mp1 kPaper{};
constexpr Mp1 kLargest{.width = 128, .height = 128};

// 1,024 triangles, one a PE, that all touch `areas` areas of a plane of 1,024.
ShotCounts one_level(std::uint64_t areas) {
    ShotCounts counts;
    counts.patches = counts.patches_visible = counts.patches_projected = 1024;
    counts.areas_visited = areas * 1024;
    counts.proxels_inside = areas * 1024 * 100;
    counts.plane_areas = 1024;
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
    const auto small = seconds(one_level(1), kPaper), large = seconds(one_level(1), kLargest);
    EXPECT_NEAR(small.projection() / large.projection(), 1, 1e-9);
    EXPECT_LE(speed_up(small, large), 1);
}

TEST(CostModel, SpeedUpGrowsWithTheAreasOfTheSmallArray) {
    const auto large = seconds(one_level(1), kLargest);
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

// The table at the end of docs/mp1-cost-model.md.
TEST(CostModel, WorkedExampleOfTheDocs) {
    const auto shot = seconds(one_level(4), kPaper);
    RecordProperty("total", std::to_string(shot.total()));
    std::printf(
        "cull %g set_up %g diffusion %g inside %g depth %g acc %g update %g choose %g = %g"
        " share %g\n",
        shot.cull, shot.set_up, shot.diffusion, shot.inside_tests, shot.depth, shot.accumulate,
        shot.update, shot.choose, shot.total(), diffusion_share(shot));
    const auto big = seconds(one_level(1), kLargest);
    std::printf("128: acc %g choose %g total %g up %g proj-up %g\n", big.accumulate, big.choose,
                big.total(), speed_up(shot, big), shot.projection() / big.projection());
    for (auto e : {Evaluation::direct, Evaluation::deltas_only}) {
        const auto v = seconds(one_level(4), kPaper, {.evaluation = e});
        std::printf("inside %g depth %g total %g\n", v.inside_tests, v.depth, v.total());
    }
}

}  // namespace
}  // namespace mp1map
