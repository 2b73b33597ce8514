#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cli/solve_identity.h"
#include "solver/solve_state.h"

namespace hemirad {

/// A solve that may go on later. As a file: a line that names the format, a line of JSON, the
/// numbers of the state, little-endian, and the SHA-256 of all that as text.
struct Checkpoint {
    SolveIdentity made_with;
    double tolerance = 0;
    SolveState state;
};

/// Atomically; throws OutputError where it cannot be.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// Throws InputError, `FILE: reason`, where it is none, of another format, or not as it was
/// written.
Checkpoint read_checkpoint(const std::filesystem::path& file);

/// Throws InputError where a file is there that is no checkpoint: writing one would destroy it.
void require_no_other_file(const std::filesystem::path& file);

/// Throws InputError, with the difference named, unless a solve would come by the checkpoint's
/// state: the identities are the same, and the tolerance and shots are not behind it.
void require_same_solve(const std::filesystem::path& file, const Checkpoint& checkpoint,
                        const SolveIdentity& solve, double tolerance, std::uint64_t max_shots);

/// How many shots a checkpoint of the very same solve is from its beginning; 0 where there is none.
std::uint64_t shots_of_same_solve(const std::filesystem::path& file, const SolveIdentity& solve);

/// What has to be said where it comes from another device.
std::optional<std::string> doubt(const std::filesystem::path& file, const Checkpoint& checkpoint,
                                 const SolveIdentity& solve);

}  // namespace hemirad
