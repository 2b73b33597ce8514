#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace hemirad {

/// Writes a file that appears whole or not at all, even where the program is killed: `write` fills
/// a temporary file in the same folder, which is synced to disk and then renamed, and the folder
/// synced. A symbolic link is followed; a device or pipe is written directly. Throws OutputError
/// `PATH: reason` and leaves nothing behind on failure; an InputError or OutputError of `write`
/// itself is passed on.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(std::ostream&)>& write);

/// The file itself, be it there or not, where `path` is a symbolic link: a rename would replace the
/// link.
std::filesystem::path link_target(std::filesystem::path path);

/// What is written directly.
bool is_device_or_pipe(const std::filesystem::path& path);

/// Throws OutputError where write_atomically would fail to start: for asking before a long
/// computation. Leaves the file that is there untouched, and removes temporary files from its
/// folder that killed programs left there.
void check_writable(const std::filesystem::path& path);

}  // namespace hemirad
