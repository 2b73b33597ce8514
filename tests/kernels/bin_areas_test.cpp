#include <gtest/gtest.h>

#include "support/kernel_run.h"
#include "support/rectangles.h"

namespace hemirad::test {
namespace {

constexpr std::uint32_t kResolution = 200;

struct Lists {
    std::vector<std::int32_t> begin, end;  // [tile][pe]
    std::vector<std::int32_t> slots;
};

Lists expected_lists(const RectangleStacks& rectangles, const Stacks& stacks, const Shape& shape) {
    Lists lists;
    for (const auto& of_tile : slots_by_tile(rectangles, stacks, shape, kResolution))
        for (const auto& of_pe : of_tile) {
            lists.begin.push_back(static_cast<std::int32_t>(lists.slots.size()));
            lists.slots.insert(lists.slots.end(), of_pe.begin(), of_pe.end());
            lists.end.push_back(static_cast<std::int32_t>(lists.slots.size()));
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
    run.issue(stacks.grid, run.plural(std::vector{shot}), run.plural(rectangles.projections),
              run.plural(rectangles.heights), std::int32_t(stacks.depth), ends, slots);
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
}  // namespace hemirad::test
