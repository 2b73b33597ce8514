#include "scene/printable.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace hemirad {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

/// Bytes of the sequence that a lead byte announces; 0 where no well-formed one begins with it
/// (RFC 3629).
std::size_t announced_length(unsigned char lead) {
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead < 0xe0) return 2;
    if (lead >= 0xe0 && lead < 0xf0) return 3;
    return lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
}

/// Overlong forms, surrogates and what lies beyond U+10FFFF show in the second byte.
bool second_byte_fits(unsigned char lead, unsigned char second) {
    if (lead == 0xc2) return second >= 0xa0;  // below: the C1 control characters
    if (lead == 0xe0) return second >= 0xa0;
    if (lead == 0xed) return second < 0xa0;
    if (lead == 0xf0) return second >= 0x90;
    return lead != 0xf4 || second < 0x90;
}

/// U+2028 to U+202E and U+2066 to U+2069: separate lines, or show what follows in another order, as
/// the marks U+061C, U+200E and U+200F do.
bool steers_lines(std::string_view character) {
    if (character == "\xd8\x9c") return true;
    if (character.size() != 3 || byte_at(character, 0) != 0xe2) return false;
    const auto second = byte_at(character, 1), third = byte_at(character, 2);
    if (second == 0x80) return (third >= 0xa8 && third <= 0xae) || third == 0x8e || third == 0x8f;
    return second == 0x81 && third >= 0xa6 && third <= 0xa9;
}

/// Length of the printable character that the text begins with; 0 where it begins with none.
std::size_t printable_length(std::string_view text) {
    const auto lead = byte_at(text, 0);
    const auto length = announced_length(lead);
    if (length == 1) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
    if (length == 0 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
    const bool fits = second_byte_fits(lead, byte_at(text, 1));
    return fits && !steers_lines(text.substr(0, length)) ? length : 0;
}

std::string escape_of(unsigned char byte) {
    std::array<char, 5> escape{};
    std::snprintf(escape.data(), escape.size(), "\\x%02x", byte);
    return escape.data();
}

}  // namespace

std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto length = printable_length(text);
        result += length == 0 ? escape_of(byte_at(text, 0)) : std::string(text.substr(0, length));
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

}  // namespace hemirad
