#include "lightmap/exr_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "errors.h"
#include "lightmap/chart_layout.h"
#include "scene/input_file.h"
#include "scene/short_text.h"

namespace hemirad {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Bytes of pixels that a byte of the file holds at most: deflate's of one value (RFC 1951: 258
/// bytes in two bits), which no scene's other compressions exceed by much.
constexpr std::uint64_t kMostPacked = 1032;

/// Texels times channels that OpenEXR may hold unpacked whatever the file's size: 256 MB.
constexpr std::uint64_t kSmallBlock = std::uint64_t{1} << 26;

/// Packed together, by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<std::uint64_t, 10> kLines{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
constexpr std::size_t kLongestName = 255;

/// Bytes of the types whose values are all of one size (openexr.com, OpenEXR File Layout).
constexpr auto kSizes = std::to_array<std::pair<std::string_view, std::size_t>>(
    {{"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
     {"compression", 1},    {"double", 8},    {"envmap", 1},
     {"deepImageState", 1}, {"float", 4},     {"int", 4},
     {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
     {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
     {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
     {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
     {"v3d", 24},           {"v3f", 12},      {"v3i", 12}});

struct Attribute {
    std::string name, type, value;
};

struct ExrFile {
    const std::filesystem::path& path;
    std::uint64_t size;
    std::ifstream in;
};

/// Of one part.
struct ExrPart {
    std::set<std::string> names = {};
    std::int64_t width = 0, height = 0;
    std::uint64_t channel_count = 0, lines = 1, tile_width = 1, tile_height = 1;
};

[[noreturn]] void fail(const ExrFile& file, const std::string& reason) {
    throw InputError(printable(file.path.string()) + ": " + reason);
}

template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

/// Up to the next zero.
std::string next_name(ExrFile& file) {
    std::array<char, kLongestName + 1> text{};
    file.in.getline(text.data(), text.size(), '\0');
    if (file.in.good()) return text.data();
    fail(file, "its header breaks off, or a name in it has more than " +
                   std::to_string(kLongestName) + " bytes");
}

/// None at the header's end, which a name of no letters is.
std::optional<Attribute> next_attribute(ExrFile& file) {
    Attribute attribute{next_name(file), {}, {}};
    if (attribute.name.empty()) return {};
    attribute.type = next_name(file);
    std::uint32_t size = 0;  // signed in the format; below 0 is too many, too
    const bool whole = bool(file.in.read(reinterpret_cast<char*>(&size), sizeof size));
    if (!whole || size > file.size - static_cast<std::uint64_t>(file.in.tellg()))
        fail(file,
             "attribute " + in_quotes(attribute.name) + " announces more bytes than there are");
    attribute.value.resize(size);
    file.in.read(attribute.value.data(), static_cast<std::streamsize>(size));
    return attribute;
}

/// Each is a name and 16 bytes, and a name of no letters ends them. None where that is not where
/// the value ends.
std::optional<std::uint64_t> channels_in(std::string_view value) {
    constexpr std::size_t kDescription = 16;
    std::uint64_t count = 0;
    for (; !value.empty() && value[0] != '\0'; ++count) {
        const auto end = value.find('\0');
        if (end > kLongestName || value.size() - end - 1 < kDescription) return {};
        value.remove_prefix(end + 1 + kDescription);
    }
    return value.size() == 1 ? std::optional(count) : std::nullopt;
}

bool is_preview(std::string_view value) {
    constexpr std::size_t kSides = 8, kPixel = 4;
    if (value.size() < kSides || value.size() % kPixel != 0) return false;
    const std::uint64_t width = number_at<std::uint32_t>(value, 0);
    return width * number_at<std::uint32_t>(value, 4) == (value.size() - kSides) / kPixel;
}

bool is_texts(std::string_view value) {
    constexpr std::size_t kLength = 4;
    while (value.size() >= kLength) {
        const std::size_t length = number_at<std::uint32_t>(value, 0);
        if (length > value.size() - kLength) return false;
        value.remove_prefix(kLength + length);
    }
    return value.empty();
}

/// Text, and types unknown to OpenEXR, may have any size.
bool fits(const Attribute& attribute) {
    const std::string& type = attribute.type;
    const auto known = std::ranges::find(kSizes, type, &decltype(kSizes)::value_type::first);
    if (known != kSizes.end()) return attribute.value.size() == known->second;
    if (type == "chlist") return channels_in(attribute.value).has_value();
    if (type == "preview") return is_preview(attribute.value);
    if (type == "stringvector") return is_texts(attribute.value);
    return type != "floatvector" || attribute.value.size() % sizeof(float) == 0;
}

/// Layers of samples: nothing of ours, and where OpenEXR's own faults were found (CVE-2023-5841).
void refuse_deep(const ExrFile& file) { fail(file, "is a deep image, no lightmap"); }

/// Of the window's first and last texel.
void set_sides(ExrPart& part, std::string_view value) {
    const auto at = [&](std::size_t i) {
        return std::int64_t{number_at<std::int32_t>(value, i * sizeof(std::int32_t))};
    };
    part.width = at(2) - at(0) + 1;
    part.height = at(3) - at(1) + 1;
}

void add(const ExrFile& file, ExrPart& part, const Attribute& attribute) {
    const auto& [name, type, value] = attribute;
    if (!part.names.insert(name).second)
        fail(file, "attribute " + in_quotes(name) + " is there twice");
    if (!fits(attribute))
        fail(file, "attribute " + in_quotes(name) + ": its " + std::to_string(value.size()) +
                       " bytes are no " + in_quotes(type));
    if (name == "type" && value.starts_with("deep")) refuse_deep(file);
    if (name == "channels" && type == "chlist") part.channel_count = *channels_in(value);
    if (name == "compression" && type == "compression")
        part.lines = kLines[std::min<std::size_t>(std::uint8_t(value[0]), kLines.size() - 1)];
    if (name == "dataWindow" && type == "box2i") set_sides(part, value);
    if (name == "tiles" && type == "tiledesc") {
        part.tile_width = number_at<std::uint32_t>(value, 0);
        part.tile_height = number_at<std::uint32_t>(value, 4);
    }
}

std::string times(std::uint64_t width, std::uint64_t height) {
    return size_text(width, height) + " texels";
}

void check_sides(const ExrFile& file, const ExrPart& part) {
    constexpr std::int64_t kMost = kLargestAtlas;
    if (part.width < 1 || part.height < 1 || part.width > kMost || part.height > kMost)
        fail(file, "is " + std::to_string(part.width) + " x " + std::to_string(part.height) +
                       " texels, a lightmap is at most " + std::to_string(kMost) + " a side");
    if (std::max(part.tile_width, part.tile_height) > kLargestAtlas)
        fail(file, "is in tiles of " + times(part.tile_width, part.tile_height) + ", more than " +
                       std::to_string(kMost) + " a side");
}

/// A few bytes may announce more texels than there is memory, and so may one tile, or the lines
/// that are packed together.
void check_room(const ExrFile& file, const ExrPart& part) {
    constexpr std::uint64_t kLeastSample = 2;  // bytes, of half
    const auto width = std::uint64_t(part.width), height = std::uint64_t(part.height);
    const std::uint64_t samples = width * height * part.channel_count;
    if (kLeastSample * samples > kMostPacked * file.size)
        fail(file, "announces " + times(width, height) + " of " +
                       std::to_string(part.channel_count) + " channels, more than its " +
                       std::to_string(file.size) + " bytes can hold");
    const std::uint64_t block =
        part.channel_count * std::max(width * part.lines, part.tile_width * part.tile_height);
    if (block > std::max(samples, kSmallBlock))
        fail(file, "announces tiles or groups of lines of " + std::to_string(block) +
                       " numbers, more than it holds in all");
}

}  // namespace

// A header is a list of name, type, size and value; that of several parts is several, ended by an
// empty one (openexr.com, OpenEXR File Layout).
void check_exr_headers(const std::filesystem::path& path) {
    constexpr std::uint32_t kMagic = 20000630, kDeep = 0x800, kSeveralParts = 0x1000;
    ExrFile file{path, std::filesystem::file_size(path), std::ifstream(path, std::ios::binary)};
    std::array<char, 8> start{};
    file.in.read(start.data(), start.size());
    const std::string_view bytes(start.data(), start.size());
    if (!file.in || number_at<std::uint32_t>(bytes, 0) != kMagic) fail(file, "is no OpenEXR file");
    const auto version = number_at<std::uint32_t>(bytes, 4);
    if ((version & kDeep) != 0) refuse_deep(file);
    for (bool more = true; more; more = (version & kSeveralParts) != 0) {
        ExrPart part;
        while (const auto attribute = next_attribute(file)) add(file, part, *attribute);
        if (part.names.empty() && (version & kSeveralParts) != 0) return;
        check_sides(file, part);
        check_room(file, part);
    }
}

}  // namespace hemirad
