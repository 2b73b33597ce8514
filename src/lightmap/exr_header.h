#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace hemirad {

/// The first attribute of an EXR's headers that announces more bytes than the file holds behind it:
/// OpenEXR makes room for what is announced, up to 2 GB, before it reads. None where the headers
/// break off before: that OpenEXR tells.
std::optional<std::string> oversized_attribute(const std::filesystem::path& file);

}  // namespace hemirad
