#pragma once

#include <random>
#include <vector>

#include "support/patch_database.h"

/// Stacks of bounding rectangles, and the tiles they touch.
namespace hemirad::test {

inline std::uint32_t packed(std::uint32_t first, std::uint32_t last) { return first | last << 16; }

inline constexpr std::uint32_t kEmptyRange = 1;  // from 1 to 0

struct RectangleStacks {
    std::vector<device::Rectangle> rectangles;  // [pe][level]
    std::vector<std::int32_t> heights;          // [pe]
};

/// Rectangles of all sizes from one proxel to the whole plane, every tenth of them empty.
inline RectangleStacks random_rectangles(const Stacks& stacks, std::uint32_t resolution,
                                         unsigned seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t end) {
        return static_cast<std::uint32_t>(random() % end);
    };
    const auto range = [&] {
        const auto first = below(resolution);
        const auto most =
            below(3) == 0 ? resolution : std::min<std::uint32_t>(resolution, first + 9);
        return below(20) == 0 ? kEmptyRange : packed(first, first + below(most - first));
    };
    RectangleStacks result{std::vector<device::Rectangle>(stacks.slots()), {}};
    for (auto& rectangle : result.rectangles) {
        rectangle.columns = range();
        rectangle.rows = range();
    }
    for (std::size_t pe = 0; pe < stacks.count(); ++pe)
        result.heights.push_back(static_cast<std::int32_t>(below(stacks.depth + 1)));
    return result;
}

/// Whether a range of proxels and the proxels [begin, begin + size) of a tile have one in common.
inline bool overlaps(std::uint32_t range, std::uint32_t begin, std::uint32_t size) {
    const std::uint32_t first = range & 0xffff, last = range >> 16;
    return std::max(first, begin) <= std::min(last, begin + size - 1);
}

/// Slots of the stacks whose rectangles touch each tile: [tile][pe].
inline std::vector<std::vector<std::vector<std::int32_t>>> slots_by_tile(
    const RectangleStacks& rectangles, const Stacks& stacks, const Shape& shape,
    std::uint32_t resolution) {
    std::vector<std::vector<std::vector<std::int32_t>>> result;
    for (std::uint32_t row = 0; row < resolution; row += shape.tile_height)
        for (std::uint32_t column = 0; column < resolution; column += shape.tile_width) {
            auto& of_tile = result.emplace_back(stacks.count());
            for (std::size_t pe = 0; pe < stacks.count(); ++pe)
                for (int level = 0; level < rectangles.heights[pe]; ++level) {
                    const auto slot = pe * stacks.depth + level;
                    const auto& rectangle = rectangles.rectangles[slot];
                    if (overlaps(rectangle.columns, column, shape.tile_width) &&
                        overlaps(rectangle.rows, row, shape.tile_height))
                        of_tile[pe].push_back(static_cast<std::int32_t>(slot));
                }
        }
    return result;
}

}  // namespace hemirad::test
