#pragma once

namespace hemirad {

inline constexpr int kDone = 0;
inline constexpr int kWrongUse = 1;      ///< or bad input
inline constexpr int kDeviceFailed = 2;  ///< or its compiler
inline constexpr int kNotWritten = 3;
inline constexpr int kInterrupted = 130;  ///< 128 + SIGINT, as shells count

}  // namespace hemirad
