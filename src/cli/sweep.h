#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad sweep`: single shots on many machines, a CSV row a machine.
void add_sweep(CLI::App& app, Command& chosen);

}  // namespace hemirad
