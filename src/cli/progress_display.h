#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "cli/eta.h"

namespace hemirad {

enum class ProgressStyle { none, lines, bar };

/// A bar where standard error is a terminal, lines elsewhere.
ProgressStyle progress_style(bool quiet, bool no_progress);

/// Shots, unshot fraction and time left, on standard error: a bar redrawn ten times a second, or
/// a line every few seconds.
class ProgressDisplay {
  public:
    ProgressDisplay(ProgressStyle style, double tolerance);
    ~ProgressDisplay();
    ProgressDisplay(const ProgressDisplay&) = delete;
    ProgressDisplay& operator=(const ProgressDisplay&) = delete;

    void show(std::uint64_t shots, double unshot_fraction);

    /// Takes the bar off the screen, so that other lines can follow.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;

    std::string text(std::uint64_t shots, double unshot_fraction) const;
    std::string bar(double unshot_fraction) const;

    ProgressStyle style_;
    double tolerance_;
    Eta eta_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point next_ = start_;
    bool on_screen_ = false;
};

}  // namespace hemirad
