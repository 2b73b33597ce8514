#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hemirad {

/// What a user wrote for an option. The readers below throw InputError, one line that names the
/// option, the value and what is accepted instead.
struct OptionValue {
    std::string_view option;
    std::string_view text;
};

[[noreturn]] void reject(const OptionValue& value, std::string_view accepted);

std::uint64_t whole_number(const OptionValue& value, std::uint64_t lowest, std::uint64_t highest);

/// "500M", "1.5G": a number above 0 of bytes, KiB (K), MiB (M), GiB (G) or TiB (T).
std::uint64_t byte_count(const OptionValue& value);

/// Above 0 and finite.
double positive_number(const OptionValue& value);

/// Above 0; "inf" is one too.
double positive_or_infinite(const OptionValue& value);

/// Above 0 and below 1.
double fraction(const OptionValue& value);

struct Extent {
    std::uint32_t width, height;
};

/// "32x16", both sides from 1 to 8192.
Extent extent(const OptionValue& value);

/// "0,1.5,-2": three finite numbers.
std::array<double, 3> coordinates(const OptionValue& value);

/// Index of the word among `words`.
std::size_t one_of(const OptionValue& value, const std::vector<std::string_view>& words);

}  // namespace hemirad
