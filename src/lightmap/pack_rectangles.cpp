#include "lightmap/pack_rectangles.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>

// The order of equal rectangles under qsort is the C library's choice; a stable sort keeps it ours.
#define STBRP_SORT(first, count, size, compare)                            \
    std::stable_sort((first), (first) + (count),                           \
                     [](const stbrp_rect& left, const stbrp_rect& right) { \
                         return compare(&left, &right) < 0;                \
                     })
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>

namespace hemirad {

std::vector<bool> pack_rectangles(std::vector<Rectangle>& rectangles, std::uint32_t width,
                                  std::uint32_t height) {
    std::vector<stbrp_rect> packed;
    packed.reserve(rectangles.size());
    for (const Rectangle& r : rectangles)
        packed.push_back({0, static_cast<int>(r.width), static_cast<int>(r.height), 0, 0, 0});
    std::vector<stbrp_node> nodes(width);  // as many as columns: no rounding of widths
    stbrp_context context;
    stbrp_init_target(&context, static_cast<int>(width), static_cast<int>(height), nodes.data(),
                      static_cast<int>(nodes.size()));
    stbrp_pack_rects(&context, packed.data(), static_cast<int>(packed.size()));

    std::vector<bool> placed(rectangles.size());
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        placed[i] = packed[i].was_packed != 0;
        if (!placed[i]) continue;
        rectangles[i].x = static_cast<std::uint32_t>(packed[i].x);
        rectangles[i].y = static_cast<std::uint32_t>(packed[i].y);
    }
    return placed;
}

std::uint32_t pack_rectangles(std::vector<Rectangle>& rectangles, std::uint32_t width) {
    constexpr std::uint32_t kUnbounded = std::numeric_limits<int>::max() / 2;
    [[maybe_unused]] const auto placed = pack_rectangles(rectangles, width, kUnbounded);
    assert(std::ranges::all_of(placed, std::identity{}));
    std::uint32_t height = 0;
    for (const Rectangle& r : rectangles) height = std::max(height, r.y + r.height);
    return height;
}

}  // namespace hemirad
