#include "mp1map/compile_cache.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace mp1map {
namespace {

namespace fs = std::filesystem;

std::optional<fs::path> folder_in_environment(const char* name) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') return {};
    return fs::path(value);
}

// Where PoCL looks unless POCL_CACHE_DIR says otherwise. Without a home it takes a folder in /tmp
// that it shares with other users, which we do not count.
std::optional<fs::path> pocl_default() {
    if (const auto cache = folder_in_environment("XDG_CACHE_HOME")) return *cache / "pocl";
    if (const auto home = folder_in_environment("HOME")) return *home / ".cache" / "pocl";
    return {};
}

bool usable(const fs::path& folder) {
    std::error_code fault;
    fs::create_directories(folder, fault);
    return access(folder.c_str(), W_OK | X_OK) == 0;
}

// Nobody else may own or write the folder: what lies in it is loaded as code.
bool is_private(const fs::path& folder) {
    struct stat status = {};
    return lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
           status.st_uid == geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

std::optional<fs::path> private_folder() {
    std::error_code fault;
    const auto temporary = fs::temp_directory_path(fault);
    if (fault) return {};
    const auto folder = temporary / ("hemirad-cache-" + std::to_string(geteuid()));
    mkdir(folder.c_str(), S_IRWXU);
    if (is_private(folder)) return folder;
    auto unique = folder.string() + "-XXXXXX";
    if (mkdtemp(unique.data()) == nullptr) return {};
    return fs::path(unique);
}

}  // namespace

void provide_compile_cache() {
    if (folder_in_environment("POCL_CACHE_DIR")) return;
    if (const auto folder = pocl_default(); folder && usable(*folder)) return;
    if (const auto folder = private_folder()) setenv("POCL_CACHE_DIR", folder->c_str(), 1);
}

}  // namespace mp1map
