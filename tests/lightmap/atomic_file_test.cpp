#include "lightmap/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "errors.h"
#include "lightmap/support.h"

namespace hemirad::atomic_file_test {
namespace {

namespace fs = std::filesystem;

// Root may write anywhere: gives its rights up for a while, where the test runs as root.
class Unprivileged {
  public:
    Unprivileged() {
        if (was_root_ && setresuid(65534, 65534, 0) != 0)
            throw std::runtime_error("cannot give up root");
    }
    ~Unprivileged() {
        if (was_root_ && setresuid(0, 0, 0) != 0) std::abort();
    }
    Unprivileged(const Unprivileged&) = delete;
    Unprivileged& operator=(const Unprivileged&) = delete;

  private:
    bool was_root_ = geteuid() == 0;
};

class AtomicFile : public InFolder {};

void write_text(std::ostream& stream) { stream << "whole"; }

std::string failure_of(const fs::path& path,
                       const std::function<void(std::ostream&)>& write = write_text) {
    return message_of<OutputError>([&] { write_atomically(path, write); });
}

/// A disk with room for `byte_count` bytes a file.
class SmallDisk {
  public:
    explicit SmallDisk(rlim_t byte_count) {
        getrlimit(RLIMIT_FSIZE, &before_);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{byte_count, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

  private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

TEST_F(AtomicFile, HoldsWhatWasWrittenAndNothingLiesBesideIt) {
    write_atomically(file("a.txt"), write_text);

    EXPECT_EQ(bytes_of(file("a.txt")), "whole");
    EXPECT_EQ(names_in_folder(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, ReplacesAnOlderOne) {
    std::ofstream(file("a.txt")) << "older and longer";

    write_atomically(file("a.txt"), write_text);

    EXPECT_EQ(bytes_of(file("a.txt")), "whole");
}

TEST_F(AtomicFile, HasTheModeOfTheOlderOne) {
    std::ofstream(file("a.txt")) << "older";
    fs::permissions(file("a.txt"), fs::perms::owner_read | fs::perms::owner_write);

    write_atomically(file("a.txt"), write_text);

    EXPECT_EQ(fs::status(file("a.txt")).permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(AtomicFile, ASymbolicLinkStaysOne) {
    std::ofstream(file("a.txt")) << "older";
    fs::create_symlink("a.txt", file("link"));

    write_atomically(file("link"), write_text);

    EXPECT_TRUE(fs::is_symlink(file("link")));
    EXPECT_EQ(bytes_of(file("a.txt")), "whole");
}

TEST_F(AtomicFile, ASymbolicLinkToWhatIsNotThereYetStaysOne) {
    fs::create_directory(file("there"));
    fs::create_symlink("there/link", file("link"));
    fs::create_symlink("a.txt", file("there/link"));

    check_writable(file("link"));
    write_atomically(file("link"), write_text);

    EXPECT_TRUE(fs::is_symlink(file("link")));
    EXPECT_TRUE(fs::is_symlink(file("there/link")));
    EXPECT_EQ(bytes_of(file("there/a.txt")), "whole");
}

TEST_F(AtomicFile, AMissingFolderIsNamed) {
    EXPECT_EQ(failure_of(file("no/a.txt")),
              file("no/a.txt").string() + ": No such file or directory");
    EXPECT_TRUE(names_in_folder().empty());
}

TEST_F(AtomicFile, AFileInPlaceOfTheFolderIsNamed) {
    std::ofstream(file("no"));

    EXPECT_EQ(failure_of(file("no/a.txt")), file("no/a.txt").string() + ": Not a directory");
}

TEST_F(AtomicFile, ADirectoryIsNotReplaced) {
    fs::create_directory(file("a.txt"));

    EXPECT_EQ(failure_of(file("a.txt")), file("a.txt").string() + ": is a folder");
    EXPECT_EQ(names_in_folder(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, AFolderIsNotAFile) {
    EXPECT_EQ(failure_of("no/"), "no/: names a folder, not a file");
    EXPECT_EQ(failure_of(""), ": names a folder, not a file");
}

TEST_F(AtomicFile, AnUnwritableFolderIsRefused) {
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec |
                                 fs::perms::others_read | fs::perms::others_exec);

    std::string message;
    {
        const Unprivileged user;
        message = failure_of(file("a.txt"));
    }

    fs::permissions(folder_, fs::perms::owner_all);
    EXPECT_EQ(message, file("a.txt").string() + ": Permission denied");
}

TEST_F(AtomicFile, AReadOnlyFileIsRefused) {
    std::ofstream(file("a.txt")) << "older";
    fs::permissions(file("a.txt"), fs::perms::owner_read | fs::perms::others_read);
    fs::permissions(folder_, fs::perms::all);

    std::string message;
    {
        const Unprivileged user;
        message = failure_of(file("a.txt"));
    }

    EXPECT_EQ(message, file("a.txt").string() + ": Permission denied");
    EXPECT_EQ(bytes_of(file("a.txt")), "older");
}

TEST_F(AtomicFile, AFullDiskKeepsTheOlderFileAndLeavesNothingElse) {
    std::ofstream(file("a.txt")) << "older";
    const std::string text(100'000, 'x');

    std::string message;
    {
        const SmallDisk disk(4096);
        message = failure_of(file("a.txt"), [&](std::ostream& stream) { stream << text; });
    }

    EXPECT_EQ(message, file("a.txt").string() + ": File too large");
    EXPECT_EQ(bytes_of(file("a.txt")), "older");
    EXPECT_EQ(names_in_folder(), std::set<std::string>{"a.txt"});
}

TEST_F(AtomicFile, ADeviceIsWrittenToNotReplaced) {
    write_atomically("/dev/null", write_text);

    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(failure_of("/dev/full"), "/dev/full: No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(AtomicFile, AFaultOfTheWriterLeavesNothing) {
    EXPECT_EQ(failure_of(file("a.txt"), [](std::ostream&) { throw std::runtime_error("odd"); }),
              file("a.txt").string() + ": odd");
    EXPECT_THROW(write_atomically(file("a.txt"), [](std::ostream&) { throw InputError("bad"); }),
                 InputError);
    EXPECT_TRUE(names_in_folder().empty());
}

TEST_F(AtomicFile, HasNoNameBeforeItIsWhole) {
    std::set<std::string> names{"some"};

    write_atomically(file("a.txt"), [&](std::ostream& stream) {
        stream << "half" << std::flush;
        names = names_in_folder();
        stream << " and half";
    });

    EXPECT_TRUE(names.empty());
    EXPECT_EQ(bytes_of(file("a.txt")), "half and half");
}

TEST_F(AtomicFile, WhatAKilledProgramLeftIsRemovedBeforeTheNext) {
    for (const char* name : {".hemirad-12-0", ".hemirad-12-7", ".hemirad-12-0.exr", ".hemirad"})
        std::ofstream(file(name)) << "half";
    const int descriptor = open(file(".hemirad-12-7").c_str(), O_WRONLY);
    ASSERT_EQ(flock(descriptor, LOCK_EX), 0);  // as by a program that is still at it

    check_writable(file("a.txt"));

    close(descriptor);
    EXPECT_EQ(names_in_folder(),
              (std::set<std::string>{".hemirad", ".hemirad-12-0.exr", ".hemirad-12-7"}));
}

TEST_F(AtomicFile, AskingBeforehandChangesNothing) {
    std::ofstream(file("a.txt")) << "older";

    check_writable(file("a.txt"));
    check_writable(file("b.txt"));

    EXPECT_EQ(bytes_of(file("a.txt")), "older");
    EXPECT_EQ(names_in_folder(), std::set<std::string>{"a.txt"});
    EXPECT_THROW(check_writable(file("no/a.txt")), OutputError);
    EXPECT_THROW(check_writable(folder_), OutputError);
}

}  // namespace
}  // namespace hemirad::atomic_file_test
