#pragma once

#include <string_view>

namespace hemirad {

/// A file of kernels/ or mp1map/ as it was when this binary was built, by its path in the source
/// tree, e.g. `kernels/project_patches.cl`. Empty where there is none. Includes are unresolved:
/// kernel_source() is what a compiler wants.
std::string_view embedded_kernel(std::string_view file);

}  // namespace hemirad
