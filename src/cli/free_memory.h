#pragma once

#include <cstdint>
#include <filesystem>

namespace hemirad {

/// What processes may still take, in bytes: of the machine, its free swap included, or of the
/// control groups that this process is in, where one of them has less left. What the kernel takes
/// back before it refuses, files read and not used since, counts as free. The largest number there
/// is where nothing can be told. `root` is where /proc and /sys are.
std::uint64_t free_memory(const std::filesystem::path& root = "/");

}  // namespace hemirad
