#include "scene/csv.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace hemirad {
namespace {

/// Some take full-width forms, U+FF01 to U+FF5E, for ASCII.
std::string in_half_width(std::string_view text) {
    std::string half;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::string_view form = text.substr(i, 3);
        const bool is_full = (form >= "\uff01" && form <= "\uff5e") && form.size() == 3;
        half += is_full ? static_cast<char>('!' + (form[1] - '\xbc') * 64 + (form[2] - '\x81'))
                        : text[i];
        if (is_full) i += 2;
    }
    return half;
}

/// A spreadsheet computes what begins like this, and some of it runs programs. A sign alone does no
/// harm: "+x" and "-x" are common names of walls. A back is named as its front is.
bool is_formula(std::string_view text) {
    constexpr std::string_view kBack = " (back)";
    if (text.ends_with(kBack)) text.remove_suffix(kBack.size());
    if (text.empty()) return false;
    if (text[0] == '=' || text[0] == '@') return true;
    return (text[0] == '+' || text[0] == '-') && text.find_first_of("(|!") != text.npos;
}

/// With an apostrophe before each formula, which makes it text. Where the list separator is `;`, or
/// a tab, the line that holds the name is cut there, whatever quotes say; no wall is named so.
std::string inert(std::string_view name) {
    constexpr std::string_view kBegins = "=+-@";
    std::string text;
    for (std::size_t begin = 0; begin < name.size();) {
        const char first = in_half_width(name.substr(begin, 3))[0];
        if (begin == 0 ? is_formula(in_half_width(name)) : kBegins.find(first) != kBegins.npos)
            text += '\'';
        const std::size_t end = std::min(name.find_first_of(";\t", begin), name.size() - 1) + 1;
        text += name.substr(begin, end - begin);
        begin = end;
    }
    return text;
}

}  // namespace

std::string csv_field(std::string_view name) {
    const std::string text = inert(name);
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
