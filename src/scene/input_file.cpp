#include "scene/input_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "errors.h"

namespace hemirad {
namespace {

void check_reflectance(const InputFile& file, const Material& material, double value) {
    const std::string element = "material " + in_quotes(material.name);
    if (!std::isfinite(value)) fail(file, element, "reflectance is not finite");
    if (value < 0) fail(file, element, "reflectance " + number(value) + " is below 0");
    if (value > 1) fail(file, element, "reflectance " + number(value) + " is above 1");
}

void check_emission(const InputFile& file, const Material& material, double value) {
    const std::string element = "material " + in_quotes(material.name);
    if (!std::isfinite(value)) fail(file, element, "emission is not finite");
    if (value < 0) fail(file, element, "emission " + number(value) + " is below 0");
}

}  // namespace

InputFile read_input_file(const std::filesystem::path& path) {
    InputFile file{path, printable(path.filename().string()), {}};
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        throw InputError(printable(path.string()) + ": does not exist");
    }
    if (std::filesystem::is_directory(status)) {
        throw InputError(printable(path.string()) + ": is a folder, not a scene file");
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError(printable(path.string()) + ": is not a regular file");
    }
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream bytes;
    if (stream.peek() != std::ifstream::traits_type::eof()) bytes << stream.rdbuf();
    // A fault on the way is told to the one that copies.
    if (!stream || !bytes) throw InputError(printable(path.string()) + ": cannot be read");
    file.bytes = std::move(bytes).str();
    return file;
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t kLongest = 200;  // a few lines of a terminal; names may be a megabyte
    std::size_t length = std::min(text.size(), kLongest);
    const auto is_inside = [&](char c) { return (c & 0xc0) == 0x80; };  // a character of UTF-8
    while (length < text.size() && length > kLongest - 4 && is_inside(text[length])) --length;
    std::string result(1, '"');
    result += printable(text.substr(0, length));
    if (length < text.size()) result += "...";
    return result += '"';
}

void check_name(const InputFile& file, const std::string& kind, std::string_view name) {
    constexpr std::size_t kLongest = 1000;  // bytes; Blender's have 63, paths of IFC some hundred
    if (name.size() <= kLongest) return;
    fail(file, kind + ' ' + in_quotes(name),
         "its name has " + std::to_string(name.size()) + " bytes, more than the " +
             std::to_string(kLongest) + " that are read");
}

std::string number(double value) {
    std::array<char, 512> text{};
    std::snprintf(text.data(), text.size(), "%.2f", value);
    if (std::strtod(text.data(), nullptr) == value && std::abs(value) < 1e6) return text.data();
    std::snprintf(text.data(), text.size(), "%.9g", value);
    return text.data();
}

void fail(const InputFile& file, const std::string& element, const std::string& reason) {
    throw InputError(file.name + ": " + element + ": " + reason);
}

void warn(Scene& scene, const std::string& element, const std::string& reason) {
    scene.warnings.push_back(printable(scene.file) + ": " + element + ": " + reason);
}

std::optional<std::filesystem::path> resolve_reference(const InputFile& file,
                                                       const std::string& reference) {
    const std::filesystem::path relative(reference);
    const bool windows = reference.find_first_of("\\:") != std::string::npos;
    if (reference.empty() || relative.is_absolute() || windows) return std::nullopt;
    const auto normal = relative.lexically_normal();
    if (*normal.begin() == "..") return std::nullopt;
    return file.path.parent_path() / normal;
}

void check_scene(const InputFile& file, const Scene& scene) {
    for (const auto& material : scene.materials) {
        for (const double value : material.reflectance) check_reflectance(file, material, value);
        for (const double value : material.emission) check_emission(file, material, value);
    }
    if (scene.faces.empty()) throw InputError(file.name + ": holds no faces");
}

std::filesystem::file_status status_of(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::status(path, ignored);
}

}  // namespace hemirad
