#include "cli/checkpoints.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "cli/checkpoint_file.h"
#include "cli/text.h"
#include "errors.h"

namespace hemirad {

Checkpoints::Checkpoints(const SolveOptions& options, SolveIdentity solve)
    : file_(options.checkpoint),
      tolerance_(options.solver.tolerance),
      solve_(std::move(solve)),
      moments_(options.checkpoint_every) {
    if (file_ && !options.resume) shots_there_ = shots_of_same_solve(*file_, solve_);
}

std::optional<std::string> Checkpoints::note(const Progress& progress, ProgressiveSolver& solver) {
    if (!file_ || !moments_.due(progress)) return {};
    const auto fault = write(solver);
    if (!fault || std::exchange(has_warned_, true)) return {};
    return *fault + "; the solve goes on, and the checkpoint is tried again";
}

std::optional<std::string> Checkpoints::write(ProgressiveSolver& solver) try {
    if (!file_) return {};
    auto state = solver.state();
    std::error_code ignored;
    const bool is_nothing = state.shots == 0 && std::filesystem::exists(*file_, ignored);
    if (!is_nothing && state.shots >= shots_there_)
        write_checkpoint(*file_, {solve_, tolerance_, std::move(state)});
    return {};
} catch (const OutputError& fault) {
    return fault.what();
}

std::optional<std::string> Checkpoints::warning() const {
    if (shots_there_ == 0) return {};
    return file_->string() + ": holds this solve after " + counted(shots_there_, "shot") +
           ", and stays until it is that far again; --resume goes on from there";
}

}  // namespace hemirad
