#pragma once

#include <cstdint>
#include <vector>

namespace hemirad {

struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Places those rectangles that fit into one of `width` x `height`, in which each would fit alone,
/// without overlap; returns which. Rectangles of equal size are placed in their order.
std::vector<bool> pack_rectangles(std::vector<Rectangle>& rectangles, std::uint32_t width,
                                  std::uint32_t height);

/// Places rectangles, none wider than `width`, without overlap on a strip of that width; returns
/// the height they take. Rectangles of equal size are placed in their order.
std::uint32_t pack_rectangles(std::vector<Rectangle>& rectangles, std::uint32_t width);

}  // namespace hemirad
