#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/projector.h"
#include "support/kernel_run.h"
#include "support/pipeline.h"

namespace hemirad::test::init_plane_test {
namespace {

// The squares that tiles of a shape cover: the plane, and what the last tiles have beyond it.
struct Cover {
    std::uint32_t columns, rows;
};

Cover cover_of(const Shape& shape, std::uint32_t resolution) {
    return {(resolution + shape.tile_width - 1) / shape.tile_width,
            (resolution + shape.tile_height - 1) / shape.tile_height};
}

// Where a proxel lies in the plural variable: tile, then area of the tile, then PE, then lane.
std::size_t plural_index(const Shape& shape, std::uint32_t resolution, std::uint32_t column,
                         std::uint32_t row) {
    const std::uint32_t area_width = shape.width * shape.lanes;
    const std::size_t tile =
        row / shape.tile_height * cover_of(shape, resolution).columns + column / shape.tile_width;
    const std::uint32_t x = column % shape.tile_width, y = row % shape.tile_height;
    const std::uint32_t area = y / shape.height * (shape.tile_width / area_width) + x / area_width;
    const std::uint32_t pe = y % shape.height * shape.width + x % area_width / shape.lanes;
    return tile * shape.tile_width * shape.tile_height +
           (area * shape.width * shape.height + pe) * shape.lanes + x % shape.lanes;
}

float expected_root(std::int64_t resolution, std::int64_t column, std::int64_t row) {
    const std::int64_t a = 2 * column + 1 - resolution, b = 2 * row + 1 - resolution;
    const std::int64_t squared = resolution * resolution - a * a - b * b;
    if (squared <= 0) return 0;
    return std::sqrt(static_cast<float>(squared)) / static_cast<float>(resolution);
}

std::vector<float> roots_of(const Shape& shape, std::uint32_t resolution) {
    KernelOptions options;
    options.lanes = shape.lanes;
    options.pe_width = shape.width;
    options.pe_height = shape.height;
    options.tile_width = shape.tile_width;
    options.tile_height = shape.tile_height;
    options.resolution = resolution;
    KernelRun run("init_plane", options);
    const auto cover = cover_of(shape, resolution);
    const std::size_t tiles = std::size_t{cover.columns} * cover.rows;
    auto roots = run.plural(std::vector<float>(tiles * shape.tile_width * shape.tile_height,
                                               -1.0f));  // not yet written
    run.issue({tiles, shape.width * shape.height}, roots);
    return run.acu().unload(roots);
}

class InitPlane : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, InitPlane, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(InitPlane, EveryProxelHoldsItsSquareRootAndThoseOutsideTheDiskZero) {
    for (const std::uint32_t resolution : {64u, 101u}) {
        const auto roots = roots_of(GetParam(), resolution);

        std::vector<float> expected(roots.size());
        const auto cover = cover_of(GetParam(), resolution);
        for (std::uint32_t row = 0; row < cover.rows * GetParam().tile_height; ++row)
            for (std::uint32_t column = 0; column < cover.columns * GetParam().tile_width; ++column)
                expected[plural_index(GetParam(), resolution, column, row)] =
                    expected_root(resolution, column, row);
        EXPECT_EQ(bits(roots), bits(expected)) << "resolution " << resolution;
    }
}

TEST(InitPlaneOfThreeThousand, RootsAreZeroOutsideTheDiskAndNowhereElse) {
    const auto roots = roots_of({4, 1, 16, 64, 64}, 3001);

    const auto in_disk = std::count_if(roots.begin(), roots.end(), [](float r) { return r > 0; });
    EXPECT_EQ(static_cast<std::uint64_t>(in_disk), reference::disk_proxel_count(3001));
}

}  // namespace
}  // namespace hemirad::test::init_plane_test
