#include "lightmap/exr_header.h"

#include <bit>
#include <cstdint>
#include <fstream>

namespace hemirad {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Moves past an attribute that the file holds; returns whether it does.
bool skip_attribute(std::istream& in, std::uint64_t length) {
    std::uint32_t size = 0;  // signed in the format; below 0 is too many, too
    if (!in.read(reinterpret_cast<char*>(&size), sizeof size)) return true;
    const auto at = static_cast<std::uint64_t>(in.tellg());
    if (size > length - at) return false;
    in.seekg(size, std::ios::cur);
    return true;
}

}  // namespace

// A header is a list of name, type, size and value, which a name of no letters ends; that of
// several parts is several, ended by an empty one (openexr.com, OpenEXR File Layout).
std::optional<std::string> oversized_attribute(const std::filesystem::path& file) {
    constexpr std::streamoff kVersionEnds = 8;
    const std::uint64_t length = std::filesystem::file_size(file);
    std::ifstream in(file, std::ios::binary);
    in.seekg(kVersionEnds);
    std::string name, type;
    while (std::getline(in, name, '\0') && !name.empty()) {
        std::getline(in, type, '\0');
        if (!skip_attribute(in, length)) return name;
    }
    return {};
}

}  // namespace hemirad
