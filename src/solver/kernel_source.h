#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace hemirad {

/// The source of kernels/NAME.cl with its `#include "..."` lines resolved, each file once. `#line`
/// directives keep the real file and line, so a build log reads like the tree. Includes are looked
/// up by file name in kernels/, then in mp1map/.
///
/// Without a folder the sources embedded in the binary are read; with one, the files of that folder
/// and of its sibling `../mp1map`; a sibling that does not exist leaves the embedded mp1map.
/// Throws InputError where a file is missing.
std::string kernel_source(std::string_view name,
                          const std::optional<std::filesystem::path>& kernels_dir = {});

/// The same for a source that is not a file of kernels/: the probes of the tests.
std::string resolve_includes(std::string_view text, std::string_view file,
                             const std::optional<std::filesystem::path>& kernels_dir = {});

}  // namespace hemirad
