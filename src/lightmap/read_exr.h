#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lightmap/lightmap.h"

namespace hemirad {

/// A lightmap as write_exr() wrote it, or another program with channels of such names.
struct ExrLightmap {
    Lightmap lightmap;
    std::map<std::string, std::string> attributes;  ///< those of text, `hemirad.` taken off
};

/// Takes the `bands`, in their order, and each layer that has all of them; coverage is 1 where the
/// file has none. Throws InputError, also where a band is missing.
ExrLightmap read_exr(const std::filesystem::path& path, const std::vector<std::string>& bands);

}  // namespace hemirad
