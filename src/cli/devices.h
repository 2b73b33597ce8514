#pragma once

#include "cli/options.h"

namespace hemirad {

/// `hemirad devices`: the OpenCL devices and the PE array each would get.
void add_devices(CLI::App& app, Command& chosen);

}  // namespace hemirad
