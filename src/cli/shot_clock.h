#pragma once

#include <vector>

#include "solver/solver.h"

namespace hemirad {

/// Seconds a shot, as the calls of the solver's callback show them: the median over the calls, so
/// that a snapshot or a busy machine in between does not count.
class ShotClock {
  public:
    /// `shots`: made before the first call's.
    explicit ShotClock(std::uint64_t shots = 0) : last_{.shots = shots} {}

    void note(const Progress& progress);
    double median() const;  ///< 0 before the first call

  private:
    Progress last_;
    std::vector<double> seconds_a_shot_;
};

}  // namespace hemirad
