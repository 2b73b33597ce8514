#include "lightmap/part_names.h"

#include <array>
#include <cstdio>

#include "scene/printable.h"

namespace hemirad {
namespace {

/// With "hemirad.layer.light." before it or a band's name behind it, below the 255 of an EXR.
constexpr std::size_t kLongestName = 120;

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
}

std::string escaped(std::string_view name) {
    std::string result;
    for (const char c : name) {
        std::array<char, 4> escape{c};
        if (!is_plain(c))
            std::snprintf(escape.data(), escape.size(), "%%%02X", static_cast<unsigned char>(c));
        result += escape.data();
    }
    return result;
}

/// No other name holds a ~.
std::string channel_name(std::string_view name, std::size_t number) {
    std::string result = escaped(name);
    if (!result.empty() && result.size() <= kLongestName) return result;
    return result.substr(0, kLongestName) + "~" + std::to_string(number);
}

}  // namespace

std::vector<std::string> part_names(const Solution& solution) {
    std::vector<std::string> names;
    for (const SolutionPart& part : solution.parts) {
        if (part.kind == SolutionPart::Kind::light)
            names.push_back("light." + channel_name(part.name, names.size()));
        else
            names.push_back(part.kind == SolutionPart::Kind::direct ? "direct" : "indirect");
    }
    return names;
}

std::string part_meaning(const SolutionPart& part) {
    switch (part.kind) {
        case SolutionPart::Kind::light:
            return "light \"" + printable(part.name) + "\", reflections included";
        case SolutionPart::Kind::direct:
            return "light straight from its emitters";
        case SolutionPart::Kind::indirect:
            return "light that was reflected before";
    }
    return {};
}

}  // namespace hemirad
