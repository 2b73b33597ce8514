#pragma once

#include <map>
#include <string>
#include <vector>

#include "mp1map/device.h"

namespace mp1map {

/// A compiled kernel, under the name of its file and entry point.
struct Kernel {
    std::string name;
    cl::Kernel handle;
    std::size_t most_work_items = 0;  ///< that a group of it may have on its device
};

/// Compiles `source`, which holds a kernel of each of the names, as one program: the compiler reads
/// its built-ins once. `options` as for the OpenCL C compiler. Throws DeviceError with the build
/// log.
std::map<std::string, Kernel> build_kernels(const Device& device,
                                            const std::vector<std::string>& names,
                                            const std::string& source, const std::string& options);

}  // namespace mp1map
