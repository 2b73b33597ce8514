#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad info`: what a scene holds and what the solver will therefore build.
void add_info(CLI::App& app, Command& chosen);

}  // namespace hemirad
