#include <gtest/gtest.h>

#include "support/kernel_run.h"
#include "support/rectangles.h"

namespace hemirad::test::bin_areas_test {
namespace {

constexpr std::uint32_t kResolution = 200;

struct Lists {
    std::vector<std::int32_t> begin, end;  // [pe][tile]
    std::vector<std::int32_t> slots;       // by tile, and in it by PE
};

Lists expected_lists(const RectangleStacks& rectangles, const Stacks& stacks, const Shape& shape) {
    const auto by_tile = slots_by_tile(rectangles, stacks, shape, kResolution);
    Lists lists;
    lists.begin.resize(by_tile.size() * stacks.count());
    lists.end = lists.begin;
    for (std::size_t tile = 0; tile < by_tile.size(); ++tile)
        for (std::size_t pe = 0; pe < stacks.count(); ++pe) {
            const auto& slots = by_tile[tile][pe];
            const std::size_t at = pe * by_tile.size() + tile;
            lists.begin[at] = static_cast<std::int32_t>(lists.slots.size());
            lists.slots.insert(lists.slots.end(), slots.begin(), slots.end());
            lists.end[at] = static_cast<std::int32_t>(lists.slots.size());
        }
    return lists;
}

// Slots and ends after the kernel, which is given the beginnings.
Lists binned(const RectangleStacks& rectangles, const Stacks& stacks, const Shape& shape,
             const Lists& expected, std::int32_t status = kRunning) {
    KernelOptions options;
    options.tile_width = shape.tile_width;
    options.tile_height = shape.tile_height;
    options.resolution = kResolution;
    KernelRun run("bin_areas", options);
    device::Shot shot{};
    shot.status = status;
    auto ends = run.plural(expected.begin);
    auto slots = run.plural(std::vector<std::int32_t>(expected.slots.size(), -7));
    run.issue(run.fitting(stacks.grid), run.plural(std::vector{shot}),
              run.plural(rectangles.rectangles), run.plural(rectangles.heights),
              std::int32_t(stacks.depth), ends, slots);
    return {expected.begin, run.acu().unload(ends), run.acu().unload(slots)};
}

class BinAreas : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, BinAreas, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(BinAreas, TheListOfATileHoldsItsPatchesInAscendingOrder) {
    const Stacks stacks(GetParam(), 1024);
    const auto rectangles = random_rectangles(stacks, kResolution, 40);
    const auto expected = expected_lists(rectangles, stacks, GetParam());

    const auto lists = binned(rectangles, stacks, GetParam(), expected);

    EXPECT_EQ(lists.slots, expected.slots);
    EXPECT_EQ(lists.end, expected.end);
}

TEST(BinAreasOfAHaltedShot, WritesNothing) {
    const Shape& shape = shapes()[1];
    const Stacks stacks(shape, 1024);
    const auto rectangles = random_rectangles(stacks, kResolution, 41);
    const auto expected = expected_lists(rectangles, stacks, shape);

    const auto lists = binned(rectangles, stacks, shape, expected, kBinsFull);

    EXPECT_EQ(lists.slots, std::vector<std::int32_t>(expected.slots.size(), -7));
    EXPECT_EQ(lists.end, expected.begin);
}

}  // namespace
}  // namespace hemirad::test::bin_areas_test
