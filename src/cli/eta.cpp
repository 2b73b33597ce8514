#include "cli/eta.h"

#include <algorithm>
#include <cmath>

#include "cli/text.h"

namespace hemirad {

bool is_enough_to_foretell(double seconds, double share) { return seconds >= 3 && share >= 0.01; }

std::string left_text(std::optional<double> seconds) {
    constexpr double kLongest = 3.6e6;
    if (!seconds || !(*seconds <= kLongest)) return {};
    return ", " + duration_text(*seconds) + " left";
}

void Eta::note(double seconds, double unshot_fraction) {
    constexpr double kSpacing = 0.05;  // s; shots can be far shorter than that
    if (!samples_.empty() && seconds - samples_.back().seconds < kSpacing) return;
    if (unshot_fraction > 0) samples_.push_back({seconds, std::log(unshot_fraction)});
}

std::optional<double> Eta::remaining() const {
    if (samples_.size() < 2) return {};
    const auto& last = samples_.back();
    const auto left = last.log_unshot - std::log(tolerance_);
    if (left <= 0) return 0;
    const double come = samples_.front().log_unshot - last.log_unshot;
    if (!is_enough_to_foretell(last.seconds - samples_.front().seconds, come / (come + left)))
        return {};
    const double half = (samples_.front().seconds + last.seconds) / 2;
    const auto middle = std::find_if(samples_.rbegin() + 1, samples_.rend(),
                                     [half](const Sample& one) { return one.seconds <= half; });
    const auto& from = middle == samples_.rend() ? samples_.front() : *middle;
    const double decay = (from.log_unshot - last.log_unshot) / (last.seconds - from.seconds);
    if (!(decay > 0) || !std::isfinite(decay)) return {};
    return left / decay;
}

}  // namespace hemirad
