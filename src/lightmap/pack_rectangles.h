#pragma once

#include <cstdint>
#include <vector>

namespace hemirad {

struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Places rectangles, none wider than `width`, without overlap on a strip of that width; returns
/// the height they take. Rectangles of equal size are placed in their order.
std::uint32_t pack_rectangles(std::vector<Rectangle>& rectangles, std::uint32_t width);

}  // namespace hemirad
