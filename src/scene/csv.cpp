#include "scene/csv.h"

#include <array>
#include <charconv>

namespace hemirad {
namespace {

/// A spreadsheet computes what begins like this, and some of it runs programs. A sign alone does no
/// harm: "+x" and "-x" are common names of walls. A back is named as its front is.
bool is_formula(std::string_view text) {
    constexpr std::string_view kBack = " (back)";
    if (text.ends_with(kBack)) text.remove_suffix(kBack.size());
    if (text.empty()) return false;
    if (text[0] == '=' || text[0] == '@') return true;
    return (text[0] == '+' || text[0] == '-') && text.find_first_of("(|!") != text.npos;
}

}  // namespace

std::string csv_field(std::string_view name) {
    const std::string text = (is_formula(name) ? "'" : "") + std::string(name);
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string field = "\"";
    for (const char c : text) field.append(c == '"' ? 2 : 1, c);
    return field + '"';
}

std::string decimal(double value) {
    constexpr int kDigits = 9;
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                   std::chars_format::general, kDigits);
    return {text.data(), end.ptr};
}

}  // namespace hemirad
