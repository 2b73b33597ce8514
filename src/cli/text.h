#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hemirad {

/// The shortest text that reads back as the same number.
std::string number_text(double number);

/// To seven digits, for people: 31.415926535 -> "31.41593".
std::string rounded_text(double number);

/// 0.98765 -> "98.8 %".
std::string percent_text(double fraction);

/// 1536 -> "1.5 KiB".
std::string bytes_text(std::uint64_t bytes);

/// 0.0123 -> "12 ms", 3.2 -> "3.2 s", 200 -> "3 min 20 s", 7500 -> "2 h 5 min".
std::string duration_text(double seconds);

/// "1 patch", "2 patches"; `plural` where an s does not do.
std::string counted(std::uint64_t count, std::string_view singular, std::string_view plural = {});

}  // namespace hemirad
