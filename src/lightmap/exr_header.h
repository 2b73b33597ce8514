#pragma once

#include <filesystem>

namespace hemirad {

/// Walks the headers of an EXR before OpenEXR does, which takes the length of lists and pictures
/// from their bytes, whatever the attribute's size says, makes room for what is announced, up to
/// 2 GB, and goes on where it stopped. Throws InputError where an attribute's size is not that of
/// its type or of what it holds, or where the texels are too many for a lightmap or for the file.
void check_exr_headers(const std::filesystem::path& file);

}  // namespace hemirad
