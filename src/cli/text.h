#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hemirad {

/// The text with its control characters written as \n, \t or \x1b: names out of files and
/// arguments must not steer a terminal or break a line in two.
std::string escaped(std::string_view text);

/// The shortest text that reads back as the same number.
std::string number_text(double number);

/// 1536 -> "1.5 KiB".
std::string bytes_text(std::uint64_t bytes);

/// 0.0123 -> "12 ms", 3.2 -> "3.2 s", 200 -> "3 min 20 s", 7500 -> "2 h 5 min".
std::string duration_text(double seconds);

/// "1 patch", "2 patches"; `plural` where an s does not do.
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural = {});

}  // namespace hemirad
