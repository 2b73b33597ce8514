#pragma once

#include <string>
#include <string_view>

namespace hemirad {

/// As zlib streams it (RFC 1950).
std::string deflated(std::string_view bytes);

}  // namespace hemirad
