#include "lightmap/find_splits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "lightmap/cell_values.h"
#include "lightmap/support.h"
#include "support/peak_memory.h"

namespace hemirad::find_splits_test {
namespace {

/// Squares of 2 m, of which those left of `x` are split into squares of 1 m.
Mesh floor_split_left_of(double x) {
    Mesh mesh;
    add_surface(mesh, 16, 8, {1.0, 1.0});
    for (std::uint32_t row = 0; row < 8; row += 2)
        for (std::uint32_t column = 0; column < 16; column += 2) {
            const std::uint32_t scale = column < x ? 0 : 1, side = 1u << scale;
            for (std::uint32_t b = row; b < row + 2; b += side)
                for (std::uint32_t a = column; a < column + 2; a += side) {
                    const glm::dvec2 low(a, b), high = low + double(side);
                    add_patch(mesh, b * 16 + a, {low, {high.x, low.y}, high, {low.x, high.y}});
                    mesh.surfaces[0].scale_of_patch.push_back(static_cast<std::uint8_t>(scale));
                }
        }
    return mesh;
}

using Light = std::function<double(double x, double y)>;

std::vector<double> at_centres(const Mesh& mesh, const Light& light) {
    std::vector<double> values;
    for (const Patch& patch : mesh.patches) {
        const auto centre = mesh.centroid(patch);
        values.push_back(light(centre.x, centre.y));
    }
    return values;
}

std::vector<CellValues> cells_by_side(const Mesh& mesh, const Light& light) {
    std::vector<double> areas;
    for (const Patch& patch : mesh.patches) areas.push_back(mesh.area(patch));
    return cell_values_by_side(mesh.surfaces[0], areas, at_centres(mesh, light));
}

CellValues cells_of(const Mesh& mesh, const Light& light) { return cells_by_side(mesh, light)[0]; }

std::size_t splits(const Mesh& mesh, const Light& light, double bound) {
    Solution solution;
    solution.irradiance = {at_centres(mesh, light)};
    return static_cast<std::size_t>(
        std::ranges::count(find_splits(mesh, solution, 1, bound), true));
}

TEST(CellValues, OfOneValueAreThatValueToTheBit) {
    const auto cells = cells_of(floor_split_left_of(7), [](double, double) { return 0.1; });

    for (double x = 0; x <= 16; x += 0.3)
        for (double y = 0; y <= 8; y += 0.3) EXPECT_EQ(cells.at({x, y}, 0), 0.1);
}

TEST(CellValues, GoOnAcrossPatchesOfAnySize) {
    const auto light = [](double x, double y) { return 3 + x - 2 * y; };
    const auto cells = cells_of(floor_split_left_of(7), light);

    for (double x = 1; x <= 14.5; x += 0.3)
        for (double y = 1.5; y <= 6.5; y += 0.3)
            EXPECT_NEAR(cells.at({x, y}, 0), light(x, y), 1e-12);
}

TEST(CellValues, OfALargeCellAreTheMeanOfTheSmallOnes) {
    const auto cells = cells_of(floor_split_left_of(7), [](double x, double) { return x; });

    EXPECT_EQ(cells.at_scale(1, 0, 0), 1.0);
    EXPECT_EQ(cells.at_scale(1, 7, 3), 15.0);
    EXPECT_TRUE(std::isnan(cells.at_scale(1, -1, 0)));
    EXPECT_TRUE(std::isnan(cells.at_scale(1, 8, 0)));
}

/// A grid for each side would take 128 MB.
TEST(CellValues, OfSidesInAFewCellsEachTakeNoGridEach) {
    Mesh mesh = rectangle(400, 400);
    auto& sides = mesh.surfaces[0].side_of_patch;
    sides.assign(mesh.patches.size(), 0);
    for (std::uint8_t side = 1; side <= 100; ++side)
        for (const std::size_t far : {std::size_t{0}, sides.size() - 200}) sides[far + side] = side;
    std::vector<CellValues> cells;

    const auto bytes =
        test::peak_growth([&] { cells = cells_by_side(mesh, [](double x, double) { return x; }); });

    EXPECT_LT(bytes, 30u << 20);
    EXPECT_EQ(cells[0].at_scale(0, 200, 200), 200.5);
    for (std::int64_t side = 1; side <= 100; ++side) {
        const CellValues& own = cells[static_cast<std::size_t>(side)];
        EXPECT_EQ(own.at_scale(0, side, 0), side + 0.5);
        EXPECT_EQ(own.at_scale(0, 200 + side, 399), 200.5 + side);
        EXPECT_TRUE(std::isnan(own.at_scale(0, side + 1, 0)));
        EXPECT_TRUE(std::isnan(own.at_scale(0, 200, 200)));
        EXPECT_TRUE(std::isnan(cells[0].at_scale(0, side, 0)));
    }
}

TEST(FindSplits, FindsNoneWhereLightDoesNotChange) {
    EXPECT_EQ(splits(
                  floor_split_left_of(7), [](double, double) { return 2.0; }, 1e-9),
              0u);
}

TEST(FindSplits, FindsTheTwoSidesOfAnEdge) {
    const auto edge = [](double x, double) { return x < 12 ? 1.0 : 3.0; };

    EXPECT_EQ(splits(floor_split_left_of(0), edge, 0.1), 2u * 4);
}

TEST(FindSplits, FindsEndsOfAGradientAndNothingBetween) {
    const auto gradient = [](double x, double) { return x; };

    EXPECT_EQ(splits(floor_split_left_of(0), gradient, 0.02), 2u * 4);
    EXPECT_EQ(splits(floor_split_left_of(0), gradient, 0.1), 0u);
}

TEST(FindSplits, FindsNoneAtTheOutlineOfWhatStandsOnASurface) {
    const auto edge = [](double x, double) { return x < 12 ? 0.0 : 3.0; };
    Mesh mesh = floor_split_left_of(0);
    for (const Patch& patch : mesh.patches)
        mesh.surfaces[0].side_of_patch.push_back(mesh.centroid(patch).x < 12 ? 1 : 0);

    const auto edge_beneath = [](double x, double) { return x < 6 ? 1.0 : x < 12 ? 3.0 : 9.0; };

    EXPECT_EQ(splits(mesh, edge, 0.1), 0u);
    EXPECT_EQ(splits(mesh, edge_beneath, 0.1), 2u * 4);
}

TEST(FindSplits, NeedsTwiceTheErrorAfterASplit) {
    // The edge is estimated as a quarter of its height, of a mean of 2.25.
    const auto edge = [](double x, double) { return x < 4 ? 3.0 : 2.0; };
    const Mesh whole = floor_split_left_of(0), split = floor_split_left_of(7);

    EXPECT_EQ(splits(whole, edge, 0.1), 2u * 4);
    EXPECT_EQ(splits(split, edge, 0.1), 0u);
    EXPECT_EQ(splits(split, edge, 0.05), 2u * 8);
}

}  // namespace
}  // namespace hemirad::find_splits_test
