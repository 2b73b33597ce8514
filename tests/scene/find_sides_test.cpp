#include "scene/find_sides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

#include "support/peak_memory.h"

namespace hemirad::test::find_sides_test {
namespace {

using meshing::ContactMarks;
using meshing::find_sides;
using meshing::SidePiece;

/// Pieces of one patch each, in the cells given; `first_vertex` tells what hangs together.
std::vector<SidePiece> pieces_of(const std::vector<std::uint32_t>& regions) {
    std::vector<SidePiece> pieces;
    for (std::uint32_t p = 0; p < regions.size(); ++p) pieces.push_back({{regions[p]}, p, 1});
    return pieces;
}

Surface grid(std::uint32_t columns, std::vector<std::uint32_t> cells) {
    Surface surface;
    surface.columns = columns;
    surface.rows = columns;
    surface.cell_of_patch = std::move(cells);
    return surface;
}

bool are_near(std::uint32_t a, std::uint32_t b, std::uint32_t columns) {
    const auto apart = [](std::uint32_t x, std::uint32_t y) { return std::abs(int(x) - int(y)); };
    return apart(a / columns, b / columns) <= 2 && apart(a % columns, b % columns) <= 2;
}

TEST(FindSides, RegionsHaveTheLowestSideThatNoneBeforeThemNearbyHas) {
    constexpr std::uint32_t kColumns = 12, kRegions = 40;
    std::mt19937 random(1);
    std::vector<std::uint32_t> regions, cells;
    for (std::uint32_t p = 0; p < 150; ++p) {
        regions.push_back(p < kRegions ? p : random() % 3 ? 17 : random() % kRegions);
        cells.push_back(random() % (kColumns * kColumns));
    }

    const auto sides = find_sides(pieces_of(regions), grid(kColumns, cells), ContactMarks());

    for (std::uint32_t region = 0; region < kRegions; ++region) {
        std::set<std::uint8_t> taken;
        for (std::uint32_t p = 0; p < regions.size(); ++p)
            for (std::uint32_t q = 0; q < regions.size(); ++q)
                if (regions[p] == region && regions[q] < region &&
                    are_near(cells[p], cells[q], kColumns))
                    taken.insert(sides[q]);
        std::uint8_t lowest = 0;
        while (taken.contains(lowest)) ++lowest;
        EXPECT_EQ(sides[region], lowest) << region;
    }
}

/// Pairs of them would take 200 MB.
TEST(FindSides, ThousandsOfRegionsInACellTakeMemoryAsThereAreRegions) {
    constexpr std::uint32_t kRegions = 4000;
    std::vector<std::uint32_t> regions(kRegions);
    for (std::uint32_t region = 0; region < kRegions; ++region) regions[region] = region;
    const auto pieces = pieces_of(regions);
    const Surface surface = grid(1, std::vector<std::uint32_t>(kRegions, 0));
    std::vector<std::uint8_t> sides;

    const auto bytes = peak_growth([&] { sides = find_sides(pieces, surface, ContactMarks()); });

    EXPECT_LT(bytes, 30u << 20);
    for (std::uint32_t region = 0; region < kRegions; ++region)
        EXPECT_EQ(sides[region], std::min(region, 255u));
}

}  // namespace
}  // namespace hemirad::test::find_sides_test
