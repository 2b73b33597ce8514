#pragma once

#include <cstdint>
#include <ostream>
#include <vector>

namespace hemirad {

/// 8 bits a channel, rows from the top.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::uint32_t channel_count = 3;  ///< 1: grey
    std::vector<unsigned char> pixels;
};

void write_png(std::ostream& stream, const Picture& picture);

}  // namespace hemirad
