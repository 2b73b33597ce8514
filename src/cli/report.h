#pragma once

#include <filesystem>

#include "cli/outcome.h"
#include "cli/solve_options.h"
#include "scene/mesh.h"

namespace hemirad {

/// --report: the outcome as JSON. Throws OutputError.
void write_report(const std::filesystem::path& path, const SolveOptions& options, const Mesh& mesh,
                  const Outcome& outcome);

}  // namespace hemirad
