#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad formfactors`: view factors of a scene, light or no light.
void add_formfactors(CLI::App& app, Command& chosen);

}  // namespace hemirad
