#include "cli/checkpoints.h"

#include <utility>

#include "cli/checkpoint_file.h"
#include "errors.h"

namespace hemirad {

Checkpoints::Checkpoints(const SolveOptions& options, SolveIdentity solve)
    : file_(options.checkpoint),
      tolerance_(options.solver.tolerance),
      solve_(std::move(solve)),
      moments_(options.checkpoint_every) {}

std::optional<std::string> Checkpoints::note(const Progress& progress, ProgressiveSolver& solver) {
    if (!file_ || !moments_.due(progress)) return {};
    const auto fault = write(solver);
    if (!fault || std::exchange(has_warned_, true)) return {};
    return *fault + "; the solve goes on, and the checkpoint is tried again";
}

std::optional<std::string> Checkpoints::write(ProgressiveSolver& solver) try {
    if (file_) write_checkpoint(*file_, {solve_, tolerance_, solver.state()});
    return {};
} catch (const OutputError& fault) {
    return fault.what();
}

}  // namespace hemirad
