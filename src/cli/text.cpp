#include "cli/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace hemirad {
namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, values...);
    return text.data();
}

}  // namespace

std::string number_text(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

std::string rounded_text(double number) { return formatted("%.7g", number); }

std::string percent_text(double fraction) { return formatted("%.3g %%", 100 * fraction); }

std::string bytes_text(std::uint64_t bytes) {
    constexpr std::array kUnits{"B", "KiB", "MiB", "GiB", "TiB"};
    double amount = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; amount >= 1024 && unit + 1 < kUnits.size(); ++unit) amount /= 1024;
    return formatted(unit == 0 || amount >= 100 ? "%.0f %s" : "%.1f %s", amount, kUnits[unit]);
}

std::string duration_text(double seconds) {
    if (seconds < 0.9995) return formatted("%.0f ms", seconds * 1e3);
    if (seconds < 59.95) return formatted("%.1f s", seconds);
    const auto whole = std::llround(seconds);
    if (whole < 3600) return formatted("%lld min %lld s", whole / 60, whole % 60);
    return formatted("%lld h %lld min", whole / 3600, whole % 3600 / 60);
}

std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural) {
    const auto noun = count == 1       ? std::string(singular)
                      : plural.empty() ? std::string(singular) + "s"
                                       : std::string(plural);
    return std::to_string(count) + " " + noun;
}

}  // namespace hemirad
