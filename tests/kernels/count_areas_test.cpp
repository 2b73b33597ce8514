#include <gtest/gtest.h>

#include "support/kernel_run.h"
#include "support/rectangles.h"

namespace hemirad::test::count_areas_test {
namespace {

constexpr std::uint32_t kResolution = 200;  // not a whole number of any shape's tiles

std::vector<std::int32_t> counts_of(const RectangleStacks& rectangles, const Stacks& stacks,
                                    const Shape& shape, std::size_t tiles,
                                    std::int32_t status = kRunning) {
    KernelOptions options;
    options.tile_width = shape.tile_width;
    options.tile_height = shape.tile_height;
    options.resolution = kResolution;
    KernelRun run("count_areas", options);
    device::Shot shot{};
    shot.status = status;
    auto entries = run.plural(std::vector<std::int32_t>(tiles * stacks.count(), -7));
    run.issue(run.fitting(stacks.grid), run.plural(std::vector{shot}),
              run.plural(rectangles.rectangles), run.plural(rectangles.heights),
              std::int32_t(stacks.depth), entries);
    return run.acu().unload(entries);
}

class CountAreas : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, CountAreas, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(CountAreas, EveryPeCountsItsPatchesThatTouchEachTile) {
    const Stacks stacks(GetParam(), 1024);
    const auto rectangles = random_rectangles(stacks, kResolution, 30);
    const auto slots = slots_by_tile(rectangles, stacks, GetParam(), kResolution);

    const auto counts = counts_of(rectangles, stacks, GetParam(), slots.size());

    std::vector<std::int32_t> expected;
    for (std::size_t pe = 0; pe < stacks.count(); ++pe)
        for (const auto& of_tile : slots)
            expected.push_back(static_cast<std::int32_t>(of_tile[pe].size()));
    EXPECT_EQ(counts, expected);
}

TEST(CountAreasOfOneTile, EdgesOfRectanglesCountAndEmptyOnesDoNot) {
    const Shape shape{1, 1, 1, 10, 10};
    const Stacks stacks(shape, 16);
    RectangleStacks rectangles{std::vector<device::Rectangle>(stacks.slots()),
                               std::vector<std::int32_t>(stacks.count(), 0)};
    rectangles.heights[0] = 4;
    const auto set = [&](int level, std::uint32_t columns, std::uint32_t rows) {
        rectangles.rectangles[level] = {columns, rows};
    };
    set(0, packed(9, 10), packed(0, 0));         // two tiles, by a proxel each
    set(1, packed(10, 19), packed(0, 9));        // exactly the second
    set(2, kEmptyRange, packed(0, 9));           // none
    set(3, packed(199, 199), packed(199, 199));  // the last
    set(4, packed(0, 9), packed(0, 9));          // above the stack's height

    const auto counts = counts_of(rectangles, stacks, shape, 400);

    std::vector<std::int32_t> expected(400 * stacks.count(), 0);
    expected[0] = 1;
    expected[1] = 2;
    expected[399] = 1;
    EXPECT_EQ(counts, expected);
}

TEST(CountAreasOfAHaltedShot, WritesNothing) {
    const Stacks stacks(shapes()[1], 1024);
    const auto rectangles = random_rectangles(stacks, kResolution, 31);

    const auto counts = counts_of(rectangles, stacks, shapes()[1], 16, kBinsFull);

    EXPECT_EQ(counts, std::vector<std::int32_t>(counts.size(), -7));
}

}  // namespace
}  // namespace hemirad::test::count_areas_test
