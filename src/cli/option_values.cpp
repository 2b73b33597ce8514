#include "cli/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "errors.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

template <typename Number>
std::optional<Number> parsed(std::string_view text) {
    Number number{};
    const auto* const end = text.data() + text.size();
    const auto [rest, fault] = std::from_chars(text.data(), end, number);
    if (fault != std::errc() || rest != end) return {};
    return number;
}

}  // namespace

void reject(const OptionValue& value, std::string_view accepted) {
    throw InputError("hemirad: " + std::string(value.option) + " \"" + printable(value.text) +
                     "\": expected " + std::string(accepted));
}

std::uint64_t whole_number(const OptionValue& value, std::uint64_t lowest, std::uint64_t highest) {
    const auto number = parsed<std::uint64_t>(value.text);
    if (!number || *number < lowest || *number > highest)
        reject(value,
               "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest));
    return *number;
}

std::uint64_t byte_count(const OptionValue& value) {
    constexpr std::string_view kUnits = "KMGT";
    auto number = value.text;
    const auto unit = number.empty() ? kUnits.npos : kUnits.find(number.back());
    if (unit != kUnits.npos) number.remove_suffix(1);
    const double most = std::exp2(62);
    const double bytes = parsed<double>(number).value_or(0) *
                         (unit == kUnits.npos ? 1 : std::exp2(10 * (1.0 + double(unit))));
    if (!(bytes >= 1) || bytes > most) reject(value, "a number of bytes, as 500M or 8G");
    return static_cast<std::uint64_t>(bytes);
}

double positive_number(const OptionValue& value) {
    const auto number = parsed<double>(value.text);
    if (!number || !std::isfinite(*number) || *number <= 0) reject(value, "a number above 0");
    return *number;
}

double positive_or_infinite(const OptionValue& value) {
    const auto number = parsed<double>(value.text);
    if (!number || std::isnan(*number) || *number <= 0) reject(value, "a number above 0, or inf");
    return *number;
}

double fraction(const OptionValue& value) {
    const auto number = parsed<double>(value.text);
    if (!number || !(*number > 0 && *number < 1)) reject(value, "a number above 0 and below 1");
    return *number;
}

Extent extent(const OptionValue& value) {
    constexpr std::uint32_t kLongestSide = 8192;
    const auto cross = std::min(value.text.find('x'), value.text.size());
    const auto width = parsed<std::uint32_t>(value.text.substr(0, cross));
    const auto height =
        parsed<std::uint32_t>(value.text.substr(std::min(cross + 1, value.text.size())));
    const auto fits = [](const auto& side) { return side && *side >= 1 && *side <= kLongestSide; };
    if (!fits(width) || !fits(height)) reject(value, "WIDTHxHEIGHT, such as 32x32");
    return {*width, *height};
}

std::array<double, 3> coordinates(const OptionValue& value) {
    std::array<double, 3> numbers{};
    std::string_view rest = value.text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto comma = i + 1 < numbers.size() ? rest.find(',') : rest.size();
        const auto number = parsed<double>(rest.substr(0, std::min(comma, rest.size())));
        if (comma == rest.npos || !number || !std::isfinite(*number))
            reject(value, "three numbers, such as 0,1.5,-2");
        numbers[i] = *number;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return numbers;
}

std::size_t one_of(const OptionValue& value, const std::vector<std::string_view>& words) {
    const auto found = std::find(words.begin(), words.end(), value.text);
    if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
    std::string list(words.front());
    for (std::size_t i = 1; i < words.size(); ++i)
        list += (i + 1 == words.size() ? " or " : ", ") + std::string(words[i]);
    reject(value, list);
}

}  // namespace hemirad
