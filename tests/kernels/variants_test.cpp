// The paper's variants (sec. 1.5.3 to 1.6) against the fastest form: same bits where they must be,
// a small and counted difference where not.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/pipeline.h"

namespace hemirad::test::variants_test {
namespace {

using mp1map::Broadcast;
using mp1map::Layout;

struct Seen {
    std::vector<int> owners;
    std::vector<std::int32_t> counts;
    Activity activity;
};

Seen seen(const PipelineSettings& settings, const Shape& shape, std::uint32_t resolution = 100) {
    Aimed aimed(soup(300, 0.4, 3), shape, resolution, settings);
    aimed.aim(0);
    aimed.project();
    auto counts = aimed.pipeline().proxel_counts();
    counts.resize(aimed.pipeline().stride() + 1);  // beyond the disk: nobody asks
    return {aimed.owners(), counts,
            settings.count_activity ? aimed.pipeline().activity() : Activity{}};
}

std::int64_t differing(const std::vector<int>& a, const std::vector<int>& b) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
    return count;
}

class Variants : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, Variants,
                         testing::Values(Shape{4, 1, 16, 64, 64}, Shape{8, 8, 1, 32, 32}),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(Variants, BlockDistributionGivesTheBitsOfTheCyclicOne) {
    PipelineSettings block;
    block.pe_array.layout = Layout::block;

    EXPECT_EQ(seen(block, GetParam()).owners, seen({}, GetParam()).owners);
}

TEST_P(Variants, BroadcastOfAPatchABatchOrALevelGivesTheSameBits) {
    PipelineSettings patch, level;
    patch.pe_array.broadcast = Broadcast::patch;
    level.pe_array.broadcast = Broadcast::level;
    const auto batch = seen({}, GetParam());

    EXPECT_EQ(seen(patch, GetParam()).owners, batch.owners);
    EXPECT_EQ(seen(level, GetParam()).owners, batch.owners);
}

TEST_P(Variants, XnetGathersTheHistogramToTheLastInteger) {
    PipelineSettings xnet;
    xnet.variants.xnet = true;

    EXPECT_EQ(seen(xnet, GetParam()).counts, seen({}, GetParam()).counts);
}

TEST_P(Variants, IncrementalEvaluationDriftsByFewProxels) {
    PipelineSettings incremental;
    incremental.variants.incremental = true;

    const auto drift =
        differing(seen(incremental, GetParam(), 512).owners, seen({}, GetParam(), 512).owners);

    EXPECT_LT(drift, 512 * 512 / 10000);
}

TEST(ConstantDistance, HidesWhatTheTrueDistanceShows) {
    // A long floor strip whose centre is far, before a wall that its near end is in front of.
    PipelineSettings constant;
    constant.variants.constant_distance = true;
    const Shape shape{4, 1, 16, 64, 64};

    EXPECT_GT(differing(seen(constant, shape).owners, seen({}, shape).owners), 0);
}

TEST_P(Variants, CountingChangesNothing) {
    PipelineSettings counted;
    counted.count_activity = true;

    EXPECT_EQ(seen(counted, GetParam()).owners, seen({}, GetParam()).owners);
}

TEST_P(Variants, KernelsOfOneLaunchCountWhatTheyDoApart) {
    const auto state_after = [](bool apart) {
        PipelineSettings settings;
        settings.apart = apart;
        Aimed aimed(soup(300, 0.4, 7), GetParam(), 128, settings);
        for (const std::uint32_t shooter : {0u, 150u, 0u}) {
            aimed.pipeline().set_shooter(shooter);
            shoot(aimed.pipeline());
        }
        return std::pair(aimed.pipeline().received(), aimed.pipeline().unshot());
    };

    const auto together = state_after(false);

    EXPECT_TRUE(together == state_after(true));
    EXPECT_GT(std::ranges::max(together.first), 0.0);
}

TEST(Activity, OneSquareIsCountedInTheAreasThatItsRectangleTouches) {
    PipelineSettings counted;
    counted.count_activity = true;
    Aimed aimed(
        {square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1), square({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 1)},
        {8, 8, 1, 8, 8}, 64, counted);
    aimed.aim(0);
    aimed.project();

    const auto activity = aimed.pipeline().activity();

    const auto rectangle = aimed.pipeline().rectangles().at(0);
    const auto areas = [](std::uint32_t range) {
        return (range >> 16) / 8 - (range & 0xffff) / 8 + 1;
    };
    const auto owners = aimed.owners();
    EXPECT_EQ(activity.visited_areas, areas(rectangle.columns) * areas(rectangle.rows));
    EXPECT_EQ(activity.tile_patches, activity.visited_areas);
    EXPECT_EQ(activity.useful_proxels,
              static_cast<std::uint32_t>(std::count(owners.begin(), owners.end(), 1)));
}

}  // namespace
}  // namespace hemirad::test::variants_test
