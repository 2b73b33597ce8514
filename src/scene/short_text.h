#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace hemirad {

/// "a, b, c and 4 more": of `count` names the first `most`.
std::string names_in_short(std::size_t count, std::size_t most,
                           const std::function<std::string(std::size_t)>& name);

/// "640 x 480".
std::string size_text(std::uint64_t width, std::uint64_t height);

}  // namespace hemirad
