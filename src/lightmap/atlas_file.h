#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hemirad {

/// The file of one of several atlases: FILE.exr, FILE.1.exr, FILE.2.exr, ...
inline std::filesystem::path atlas_file(const std::filesystem::path& file, std::uint32_t atlas) {
    if (atlas == 0) return file;
    auto numbered = file;
    numbered.replace_extension();
    numbered += "." + std::to_string(atlas) + file.extension().string();
    return numbered;
}

}  // namespace hemirad
