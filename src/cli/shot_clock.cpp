#include "cli/shot_clock.h"

#include <algorithm>

namespace hemirad {

void ShotClock::note(const Progress& progress) {
    if (progress.shots > last_.shots)
        seconds_a_shot_.push_back((progress.seconds - last_.seconds) /
                                  static_cast<double>(progress.shots - last_.shots));
    last_ = progress;
}

double ShotClock::median() const {
    if (seconds_a_shot_.empty()) return 0;
    auto sorted = seconds_a_shot_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

}  // namespace hemirad
