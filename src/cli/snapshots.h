#pragma once

#include "cli/solve_options.h"
#include "solver/solver.h"

namespace hemirad {

/// When --snapshot-every asks for the next interim picture.
class Snapshots {
  public:
    /// `shots`: made before, which a whole solve had its pictures of.
    explicit Snapshots(SnapshotInterval interval, std::uint64_t shots = 0)
        : interval_(interval), periods_(interval.shots == 0 ? 0 : double(shots / interval.shots)) {}

    /// Whether one is due; if so, the next interval begins.
    bool due(const Progress& progress);

  private:
    SnapshotInterval interval_;
    double periods_;  ///< that have passed, of shots or seconds; of short ones 10^300 and more
};

}  // namespace hemirad
