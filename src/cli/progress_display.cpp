#include "cli/progress_display.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace hemirad {
namespace {

using namespace std::chrono_literals;
constexpr auto kBarInterval = 100ms;
constexpr auto kLineInterval = 5s;
constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

ProgressStyle progress_style(bool quiet, bool no_progress) {
    if (quiet || no_progress) return ProgressStyle::none;
    return isatty(STDERR_FILENO) != 0 ? ProgressStyle::bar : ProgressStyle::lines;
}

ProgressDisplay::ProgressDisplay(ProgressStyle style, double tolerance)
    : style_(style), tolerance_(tolerance), eta_(tolerance) {
    next_ += style == ProgressStyle::bar ? kBarInterval : Clock::duration(kLineInterval);
    eta_.note(0, 1);
}

ProgressDisplay::~ProgressDisplay() { clear(); }

void ProgressDisplay::show(std::uint64_t shots, double unshot_fraction) {
    const auto now = Clock::now();
    eta_.note(std::chrono::duration<double>(now - start_).count(), unshot_fraction);
    if (style_ == ProgressStyle::none || now < next_) return;
    if (style_ == ProgressStyle::bar) {
        std::cerr << kEraseLine << bar(unshot_fraction) << text(shots, unshot_fraction)
                  << std::flush;
        on_screen_ = true;
        next_ = now + kBarInterval;
    } else {
        std::cerr << text(shots, unshot_fraction) << '\n';
        next_ = now + kLineInterval;
    }
}

void ProgressDisplay::clear() {
    if (on_screen_) std::cerr << kEraseLine << std::flush;
    on_screen_ = false;
}

std::string ProgressDisplay::text(std::uint64_t shots, double unshot_fraction) const {
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "%llu shots, unshot %.3g %%",
                  static_cast<unsigned long long>(shots), 100 * unshot_fraction);
    return line.data() + left_text(eta_.remaining());
}

/// How far the logarithm of the unshot fraction has come from 1 to the tolerance.
std::string ProgressDisplay::bar(double unshot_fraction) const {
    constexpr int kWidth = 24;
    const double unshot = std::clamp(unshot_fraction, tolerance_, 1.0);
    const double done = tolerance_ < 1 ? std::log(unshot) / std::log(tolerance_) : 1;
    const auto filled = static_cast<std::size_t>(kWidth * done);
    return "[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] ";
}

}  // namespace hemirad
