#pragma once

#include <string>
#include <string_view>

namespace hemirad {

/// A field of a CSV line, RFC 4180: in quotes where it holds commas, quotes or line ends; with
/// an apostrophe before what a spreadsheet would compute.
std::string csv_field(std::string_view text);

/// 9 significant digits, like %.9g, whatever the locale.
std::string decimal(double value);

}  // namespace hemirad
