#pragma once

#include <optional>
#include <string>

#include "cli/snapshots.h"
#include "cli/solve_identity.h"
#include "cli/solve_options.h"
#include "solver/solver.h"

namespace hemirad {

/// What --checkpoint asks for. A checkpoint that cannot be written ends no solve: it is tried again
/// when the next is due, and at the end. One of the same solve that is farther is not
/// replaced, and none by that of a solve without a shot.
class Checkpoints {
  public:
    Checkpoints(const SolveOptions& options, SolveIdentity solve);

    /// Writes one where it is due. What to warn of, the first time that it cannot be.
    std::optional<std::string> note(const Progress& progress, ProgressiveSolver& solver);

    /// Of the solve's end; says why it could not be.
    std::optional<std::string> write(ProgressiveSolver& solver);

    /// What of an earlier solve lies there, for who did not ask to go on from it.
    std::optional<std::string> warning() const;

  private:
    std::optional<std::filesystem::path> file_;
    double tolerance_;
    SolveIdentity solve_;
    std::uint64_t shots_there_ = 0;  ///< of this very solve: a state that it will come to
    Snapshots moments_;
    bool has_warned_ = false;
};

}  // namespace hemirad
