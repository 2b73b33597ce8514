#pragma once

#include <filesystem>

#include "lightmap/lightmap.h"

namespace hemirad {

/// An 8-bit sRGB PNG to look at, tone-mapped; not for measuring. One band is shown grey, three as
/// red, green, blue; of two or more than three the last, the middle and the first (the longest to
/// the shortest wavelength, where bands are listed by wavelength). Throws OutputError.
void write_preview(const std::filesystem::path& path, const Lightmap& lightmap);

}  // namespace hemirad
