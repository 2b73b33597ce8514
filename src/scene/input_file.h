#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "scene/printable.h"
#include "scene/scene.h"

namespace hemirad {

/// A file as it lies on the disk, and what messages call it.
struct InputFile {
    std::filesystem::path path;
    std::string name;  ///< without folder, printable
    std::string bytes;
};

/// Throws InputError for what is missing, a folder, unreadable or empty.
InputFile read_input_file(const std::filesystem::path& path);

/// The printable text in double quotes, for messages: what is long is cut off.
std::string in_quotes(std::string_view text);
/// Throws InputError where the name is longer than any that a program gives: tables repeat names in
/// each row, so that a small file would make a large one. `kind` says what has it.
void check_name(const InputFile& file, const std::string& kind, std::string_view name);
/// At least two decimals, and as many as tell the value from its rounding: 1.20, 1.00001.
std::string number(double value);

/// Throws the InputError `FILE: ELEMENT: REASON`.
[[noreturn]] void fail(const InputFile& file, const std::string& element,
                       const std::string& reason);
/// As a line for Scene::warnings.
void warn(Scene& scene, const std::string& element, const std::string& reason);

/// Where a reference of `file` to another file leads; nothing if it is absolute, another scheme, or
/// climbs out of the file's folder: a scene from a stranger must not read what is not its own.
std::optional<std::filesystem::path> resolve_reference(const InputFile& file,
                                                       const std::string& reference);

/// Of what the path leads to; nothing, too, where no file has such a name, as it is too long.
std::filesystem::file_status status_of(const std::filesystem::path& path);

/// By its ending.
bool is_gltf(const std::filesystem::path& path);

/// What Scene promises of spectra and sizes; the checks that all formats share.
void check_scene(const InputFile& file, const Scene& scene);

Scene read_obj(const InputFile& file);
Scene read_gltf(const InputFile& file);
/// View3D's 3-D input, `F 3` and `F 3a`: surfaces with an emittance, which emit nothing.
Scene read_vs3(const InputFile& file);

}  // namespace hemirad
