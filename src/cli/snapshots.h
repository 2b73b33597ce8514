#pragma once

#include "cli/solve_options.h"
#include "solver/solver.h"

namespace hemirad {

/// When --snapshot-every asks for the next interim picture.
class Snapshots {
  public:
    explicit Snapshots(SnapshotInterval interval) : interval_(interval) {}

    /// Whether one is due; if so, the next interval begins.
    bool due(const Progress& progress);

  private:
    SnapshotInterval interval_;
    std::uint64_t periods_ = 0;  ///< that have passed, of shots or seconds
};

}  // namespace hemirad
