#include "cli/row_display.h"

#include <iostream>
#include <optional>
#include <utility>

#include "cli/eta.h"
#include "cli/text.h"

namespace hemirad {
namespace {

using namespace std::chrono_literals;
constexpr const char* kEraseLine = "\r\x1b[K";

std::chrono::milliseconds interval(ProgressStyle style) {
    return style == ProgressStyle::bar ? 100ms : 5000ms;
}

}  // namespace

RowDisplay::RowDisplay(ProgressStyle style, std::string noun)
    : style_(style), noun_(std::move(noun)), next_(start_ + interval(style)) {}

RowDisplay::~RowDisplay() {
    if (on_screen_) std::cerr << kEraseLine << std::flush;
}

void RowDisplay::show(std::size_t done, std::size_t all) {
    const auto now = Clock::now();
    if (style_ == ProgressStyle::none || now < next_) return;
    next_ = now + interval(style_);
    const double seconds = std::chrono::duration<double>(now - start_).count();
    on_screen_ = style_ == ProgressStyle::bar;
    const auto text = row_text(done, all, seconds, on_screen_, noun_);
    if (on_screen_)
        std::cerr << kEraseLine << text << std::flush;
    else
        std::cerr << text << '\n';
}

std::string row_text(std::size_t done, std::size_t all, double seconds, bool with_bar,
                     const std::string& noun) {
    constexpr std::size_t kWidth = 24;
    const double share = all > 0 ? double(done) / double(all) : 1;
    const auto filled = std::size_t(double(kWidth) * share);
    const std::string bar =
        "[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] ";
    std::optional<double> left;
    if (is_enough_to_foretell(seconds, share)) left = seconds * (1 - share) / share;
    return (with_bar ? bar : "") + std::to_string(done) + " of " + counted(all, noun) +
           left_text(left);
}

}  // namespace hemirad
