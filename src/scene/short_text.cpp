#include "scene/short_text.h"

#include <algorithm>

namespace hemirad {

std::string names_in_short(std::size_t count, std::size_t most,
                           const std::function<std::string(std::size_t)>& name) {
    std::string text;
    for (std::size_t i = 0; i < std::min(count, most); ++i) text += (i > 0 ? ", " : "") + name(i);
    if (count > most) text += " and " + std::to_string(count - most) + " more";
    return text;
}

std::string size_text(std::uint64_t width, std::uint64_t height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace hemirad
