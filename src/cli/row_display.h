#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "cli/progress_display.h"

namespace hemirad {

/// Rows, or what else is counted, done and time left, on standard error, as ProgressDisplay does
/// for shots.
class RowDisplay {
  public:
    explicit RowDisplay(ProgressStyle style, std::string noun = "row");
    ~RowDisplay();
    RowDisplay(const RowDisplay&) = delete;
    RowDisplay& operator=(const RowDisplay&) = delete;

    void show(std::size_t done, std::size_t all);

  private:
    using Clock = std::chrono::steady_clock;

    ProgressStyle style_;
    std::string noun_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_;
    bool on_screen_ = false;
};

/// "[====    ] 10 of 40 rows, 3 s left"; the bar only where asked for, the time once it is known.
std::string row_text(std::size_t done, std::size_t all, double seconds, bool with_bar,
                     const std::string& noun = "row");

}  // namespace hemirad
