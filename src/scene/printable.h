#pragma once

#include <string>
#include <string_view>

namespace hemirad {

/// The text with every byte written as \xNN that is not printable UTF-8: control characters, C1
/// ones included, what separates lines or reverses them, and what is no UTF-8 at all. A name must
/// not forge or break a line of output.
std::string printable(std::string_view text);

}  // namespace hemirad
