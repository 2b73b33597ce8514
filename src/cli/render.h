#pragma once

#include "cli/options.h"

namespace hemirad {

/// hemirad render SOLVED.glb: a picture of it.
void add_render(CLI::App& app, Command& chosen);

}  // namespace hemirad
