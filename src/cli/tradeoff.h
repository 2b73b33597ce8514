#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad tradeoff`: error against time and number of samples, of form factors and of whole
/// solves, a CSV row a setting.
void add_tradeoff(CLI::App& app, Command& chosen);

}  // namespace hemirad
