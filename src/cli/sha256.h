#pragma once

#include <filesystem>
#include <string>

namespace hemirad {

/// SHA-256 of a file's bytes, 64 hexadecimal digits. Throws OutputError where it cannot be read:
/// it is asked of what was just written.
std::string sha256(const std::filesystem::path& path);

}  // namespace hemirad
