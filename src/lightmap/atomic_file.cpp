#include "lightmap/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <new>
#include <string>
#include <string_view>
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

/// On a file system of another machine a signal may interrupt it.
bool sync(int descriptor) {
    int status = 0;
    do {
        status = fsync(descriptor);
    } while (status != 0 && errno == EINTR);
    return status == 0;
}

fs::path folder_of(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
}

/// So that a new name outlives a loss of power. File systems that cannot do it, or fail at it, have
/// a whole file under that name all the same, the older or the newer one.
void sync_folder(const fs::path& folder) {
    const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    sync(descriptor);
    close(descriptor);
}

/// Of a temporary file that has a name; a killed program may leave one.
constexpr std::string_view kPrefix = ".hemirad-";

/// An empty file beside the target, gone at the end unless it took the target's place. It gets a
/// name only in that moment, so that a killed program leaves nothing behind; from the beginning
/// where the file system knows no files without. While it lives it is locked, which tells it from
/// what was left.
class TemporaryFile {
  public:
    explicit TemporaryFile(const fs::path& target) : target_(target) {
        descriptor_ = open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
        if (descriptor_ >= 0 && faccessat(AT_FDCWD, path().c_str(), W_OK, AT_EACCESS) != 0) {
            close(descriptor_);  // no /proc, so no way to its name
            descriptor_ = -1;
        }
        while (descriptor_ < 0 && open_named()) {
        }
        if (descriptor_ >= 0) flock(descriptor_, LOCK_EX);
    }
    ~TemporaryFile() {
        if (descriptor_ < 0) return;
        if (!kept_ && !name_.empty()) unlink(name_.c_str());
        close(descriptor_);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    bool is_open() const { return descriptor_ >= 0; }
    fs::path path() const {
        return name_.empty() ? fs::path("/proc/self/fd/" + std::to_string(descriptor_)) : name_;
    }

    /// False, with errno, where disk or folder refuse.
    bool take_the_targets_place() {
        take_the_targets_mode();
        kept_ = sync(descriptor_) && (!name_.empty() || give_name()) &&
                std::rename(name_.c_str(), target_.c_str()) == 0;
        if (kept_) sync_folder(folder_of(target_));
        return kept_;
    }

  private:
    /// A picture that was kept from others stays so. Where it cannot be, it is written all the
    /// same.
    void take_the_targets_mode() const {
        struct stat status {};
        if (stat(target_.c_str(), &status) != 0) return;
        [[maybe_unused]] const int ignored =
            fchmod(descriptor_, status.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO));
    }

    fs::path name_number(int attempt) const {
        return target_.parent_path() /
               (std::string(kPrefix) + std::to_string(getpid()) + "-" + std::to_string(attempt));
    }

    template <class Make>
    bool try_names(const Make& make) {
        int attempt = 0;
        bool made = false;
        do {
            name_ = name_number(attempt++);
            made = make(name_.c_str());
        } while (!made && errno == EEXIST);
        if (!made) name_.clear();
        return made;
    }

    /// False where there is no such file to be had. Otherwise there is one, unless somebody who
    /// removes what was left found it before it was locked.
    bool open_named() {
        const bool made = try_names([&](const char* name) {
            descriptor_ = open(name, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
            return descriptor_ >= 0;
        });
        if (!made) return false;
        flock(descriptor_, LOCK_EX);
        struct stat status {};
        if (fstat(descriptor_, &status) != 0 || status.st_nlink > 0) return true;
        close(descriptor_);
        descriptor_ = -1;
        return true;
    }

    bool give_name() {
        const fs::path nameless = path();
        return try_names([&](const char* name) {
            return linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
        });
    }

    fs::path target_, name_;
    int descriptor_ = -1;
    bool kept_ = false;
};

bool is_temporary(const std::string& name) {
    return name.starts_with(kPrefix) &&
           name.find_first_not_of("0123456789-", kPrefix.size()) == std::string::npos;
}

void remove_unless_locked(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    struct stat status {};
    if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
        flock(descriptor, LOCK_EX | LOCK_NB) == 0)
        unlink(file.c_str());
    close(descriptor);
}

void remove_what_was_left(const fs::path& folder) {
    std::error_code ignored;
    for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored))
        if (is_temporary(entry->path().filename())) remove_unless_locked(entry->path());
}

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
        if (dynamic_cast<const InputError*>(&error) || dynamic_cast<const OutputError*>(&error) ||
            dynamic_cast<const std::bad_alloc*>(&error))
            throw;
        fail(path, error.what());
    }
    if (stream) stream.close();
    if (!stream) fail(path, errno);
}

/// What a rename would not notice: it replaces read-only files as well.
void require_replaceable(const fs::path& path) {
    std::error_code ignored;
    if (!path.has_filename()) fail(path, "names a folder, not a file");
    if (fs::is_directory(path, ignored)) fail(path, "is a folder");
    if (fs::exists(path, ignored) && access(path.c_str(), W_OK) != 0) fail(path, errno);
}

}  // namespace

fs::path link_target(fs::path path) {
    constexpr int kMostLinks = 40;  // Linux's path_resolution(7)
    std::error_code fault;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, fault); ++i)
        path = path.parent_path() / fs::read_symlink(path, fault);
    return path;
}

bool is_device_or_pipe(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void write_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write) {
    require_replaceable(path);
    if (is_device_or_pipe(path)) return fill(path, path, write);
    TemporaryFile temporary(link_target(path));
    if (!temporary.is_open()) fail(path, errno);
    fill(temporary.path(), path, write);
    if (!temporary.take_the_targets_place()) fail(path, errno);
}

void check_writable(const fs::path& path) {
    require_replaceable(path);
    if (is_device_or_pipe(path)) return;
    const fs::path target = link_target(path);
    const TemporaryFile temporary(target);
    if (!temporary.is_open()) fail(path, errno);
    remove_what_was_left(folder_of(target));
}

}  // namespace hemirad
