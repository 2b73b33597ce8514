#include "cli/snapshots.h"

#include <cmath>

namespace hemirad {

bool Snapshots::due(const Progress& progress) {
    double passed = 0;
    if (interval_.shots != 0) passed = static_cast<double>(progress.shots / interval_.shots);
    if (interval_.seconds > 0) passed = std::floor(progress.seconds / interval_.seconds);
    if (passed <= periods_ && std::isfinite(passed)) return false;
    periods_ = passed;
    return true;
}

}  // namespace hemirad
