#include "cli/snapshots.h"

namespace hemirad {

bool Snapshots::due(const Progress& progress) {
    std::uint64_t passed = 0;
    if (interval_.shots != 0) passed = progress.shots / interval_.shots;
    if (interval_.seconds > 0)
        passed = static_cast<std::uint64_t>(progress.seconds / interval_.seconds);
    if (passed <= periods_) return false;
    periods_ = passed;
    return true;
}

}  // namespace hemirad
