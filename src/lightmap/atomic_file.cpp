#include "lightmap/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <string>
#include <system_error>

#include "errors.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
    throw OutputError(path.string() + ": " + reason);
}

[[noreturn]] void fail(const fs::path& path, int error) {
    fail(path, error == 0 ? "cannot be written" : std::generic_category().message(error));
}

/// An empty file beside the target, removed at the end unless it took the target's place.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : target_(target) {
        const std::string prefix = ".hemirad-" + std::to_string(getpid()) + "-";
        int attempt = 0;
        do {
            path_ = target.parent_path() / (prefix + std::to_string(attempt++));
            descriptor_ = open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
        } while (descriptor_ < 0 && errno == EEXIST);
    }
    ~TemporaryFile() {
        if (descriptor_ < 0) return;
        close(descriptor_);
        if (!kept_) unlink(path_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    const fs::path& path() const { return path_; }

    /// False, with errno, where disk or folder refuse.
    bool take_the_targets_place() {
        kept_ = fsync(descriptor_) == 0 && std::rename(path_.c_str(), target_.c_str()) == 0;
        return kept_;
    }

  private:
    fs::path target_, path_;
    int descriptor_ = -1;
    bool kept_ = false;
};

/// Fills `file`; messages name `path`, what the user asked for.
void fill(const fs::path& file, const fs::path& path,
          const std::function<void(std::ostream&)>& write) {
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    try {
        if (stream) write(stream);
    } catch (const std::exception& error) {
        const int reason = errno;
        if (!stream) fail(path, reason);
        if (dynamic_cast<const InputError*>(&error) || dynamic_cast<const OutputError*>(&error)) {
            throw;
        }
        fail(path, error.what());
    }
    if (stream) stream.close();
    if (!stream) fail(path, errno);
}

/// The file itself where `path` is a symbolic link: a rename would replace the link.
fs::path resolved(const fs::path& path) {
    std::error_code ignored;
    const fs::path target = fs::canonical(path, ignored);
    return ignored ? path : target;
}

bool is_device_or_pipe(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// What a rename would not notice: it replaces read-only files as well.
void require_replaceable(const fs::path& path) {
    std::error_code ignored;
    if (!path.has_filename()) fail(path, "names a folder, not a file");
    if (fs::is_directory(path, ignored)) fail(path, EISDIR);
    if (fs::exists(path, ignored) && access(path.c_str(), W_OK) != 0) fail(path, errno);
}

}  // namespace

void write_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
    require_replaceable(path);
    if (is_device_or_pipe(path)) return fill(path, path, write);
    TemporaryFile temporary(resolved(path));
    if (!temporary.is_open()) fail(path, errno);
    fill(temporary.path(), path, write);
    if (!temporary.take_the_targets_place()) fail(path, errno);
}

void check_writable(const fs::path& path) {
    require_replaceable(path);
    if (is_device_or_pipe(path)) return;
    const TemporaryFile temporary(resolved(path));
    if (!temporary.is_open()) fail(path, errno);
}

}  // namespace hemirad
