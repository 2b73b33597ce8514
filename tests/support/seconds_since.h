#pragma once

#include <ctime>

namespace hemirad::test {

/// Sanitizers make a test take up to so many times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double kSlowdown = 4;
#else
inline constexpr double kSlowdown = 1;
#endif

/// Of this process's processors, whatever else the machine does, as without sanitizers.
inline double seconds_since(std::clock_t start) {
    return double(std::clock() - start) / CLOCKS_PER_SEC / kSlowdown;
}

}  // namespace hemirad::test
