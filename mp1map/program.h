#pragma once

#include <string>

#include "mp1map/device.h"

namespace mp1map {

/// A compiled kernel, under the name of its file and entry point.
struct Kernel {
    std::string name;
    cl::Kernel handle;
};

/// Compiles `source`, whose entry point is `name`. `options` as for the OpenCL C compiler.
/// Throws DeviceError with the build log.
Kernel build_kernel(const Device& device, const std::string& name, const std::string& source,
                    const std::string& options);

}  // namespace mp1map
