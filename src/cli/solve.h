#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad solve`: a scene to its lightmap.
void add_solve(CLI::App& app, Command& chosen);

}  // namespace hemirad
