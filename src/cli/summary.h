#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "cli/outcome.h"
#include "cli/solve_options.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// The reader's, then the mesher's, each once.
std::vector<std::string> warnings_of(const Scene& scene, const Mesh& mesh);

void print_warnings(std::ostream& out, const std::vector<std::string>& warnings);

/// What is about to be solved, and on what.
void print_plan(std::ostream& out, const SolveOptions& options, const Mesh& mesh,
                const mp1map::DeviceSummary& device, const mp1map::PeArray& array);

/// "4 x 2.7 x 5 m", along the axes: who sees 4000 has millimetres.
std::string extent_text(const Mesh& mesh);

/// "about " how long shooting takes, and how many shots that is.
std::string time_text(const Forecast& forecast);

/// How the solve ended: why, the ledger of every band, closure and files.
void print_summary(std::ostream& out, const SolveOptions& options, const Outcome& outcome);

}  // namespace hemirad
