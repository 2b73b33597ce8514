#include "cli/checkpoint_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "cli/sha256.h"
#include "errors.h"

namespace hemirad::checkpoint_file_test {
namespace {

namespace fs = std::filesystem;

SolveIdentity identity() {
    return {"1.2.3",   "scene",  "mesh",
            "kernels", "device", {{"--resolution", "64"}, {"--salvo", "8"}}};
}

Checkpoint checkpoint() {
    return {identity(), 1e-3, {42, 7, -1, 2, {0.5f, 0.25f}, {1, 2, 3}, {4, 5, 6}, {7, -0.0f}}};
}

constexpr std::size_t kDigits = 64;  // of the checksum at its end

class CheckpointFile : public testing::Test {
  protected:
    void TearDown() override { fs::remove(file_); }

    std::string written() {
        write_checkpoint(file_, checkpoint());
        std::ifstream stream(file_, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    void put(std::string_view content) { std::ofstream(file_, std::ios::binary) << content; }

    /// Without the file's name; empty where it is read.
    std::string refusal() {
        try {
            read_checkpoint(file_);
        } catch (const InputError& fault) {
            const std::string text = fault.what(), name = file_.string() + ": ";
            EXPECT_TRUE(text.starts_with(name)) << text;
            EXPECT_EQ(text.find('\n'), text.npos);
            return text.substr(name.size());
        }
        return "";
    }

    fs::path file_ =
        fs::path(testing::TempDir()) / ("hemirad-checkpoint-" + std::to_string(getpid()) + ".ckpt");
};

TEST_F(CheckpointFile, ReadsAsItWasWritten) {
    written();

    const auto read = read_checkpoint(file_);

    const auto state = checkpoint().state;
    EXPECT_EQ(read.made_with.settings, identity().settings);
    EXPECT_EQ(read.made_with.device, "device");
    EXPECT_EQ(read.tolerance, 1e-3);
    EXPECT_EQ(read.state.shots, 42u);
    EXPECT_EQ(read.state.repeated_shots, 7u);
    EXPECT_EQ(read.state.least_surplus, -1);
    EXPECT_EQ(read.state.most_surplus, 2);
    EXPECT_EQ(read.state.unshot, state.unshot);
    EXPECT_EQ(read.state.received, state.received);
    EXPECT_EQ(read.state.received_rest, state.received_rest);
    EXPECT_EQ(read.state.escaped, state.escaped);
    EXPECT_TRUE(std::signbit(read.state.escaped[1]));
}

TEST_F(CheckpointFile, IsRefusedCutShortAnywhere) {
    const auto whole = written();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        put(whole.substr(0, length));
        EXPECT_NE(refusal(), "") << length;
    }
}

TEST_F(CheckpointFile, IsRefusedWithAnyByteChanged) {
    const auto whole = written();
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int flip : {1, 0x80}) {
            auto changed = whole;
            changed[at] = static_cast<char>(changed[at] ^ flip);
            put(changed);
            EXPECT_NE(refusal(), "") << at;
        }
}

TEST_F(CheckpointFile, IsRefusedWithMoreBehindIt) {
    put(written() + "0");
    EXPECT_EQ(refusal(), "damaged or cut short: its checksum does not fit");
}

TEST_F(CheckpointFile, SaysWhatIsWrong) {
    EXPECT_EQ(refusal(), "No such file or directory");
    put("");
    EXPECT_EQ(refusal(), "not a checkpoint of hemirad");
    put("v 0 0 0\n");
    EXPECT_EQ(refusal(), "not a checkpoint of hemirad");
    put("hemirad checkpoint 2\nof the future");
    EXPECT_EQ(refusal(), "a checkpoint of format 2; this hemirad reads format 1");
    put("hemirad checkpoint 1\b\nof a format that steers a terminal");
    EXPECT_EQ(refusal(), "a checkpoint of format 1\\x08; this hemirad reads format 1");
}

TEST_F(CheckpointFile, IsRefusedWithAHeadLongerThanOurs) {
    std::string body = "hemirad checkpoint 1\n{\"a\":\"" + std::string(1 << 16, 'a') + "\"}\n";
    Sha256 sum;
    sum.add(body);
    put(body + sum.digits());

    EXPECT_EQ(refusal(), "no checkpoint that hemirad wrote: its second line has 65544 bytes");
}

TEST_F(CheckpointFile, IsRefusedWhereACountIsNone) {
    for (const std::string count : {"-42", "4.2", "1e300", "\"42\""}) {
        std::string body = written();
        body.resize(body.size() - kDigits);
        const std::string shots = "\"shots\":42";
        body.replace(body.find(shots), shots.size(), "\"shots\":" + count);
        Sha256 sum;
        sum.add(body);
        put(body + sum.digits());

        EXPECT_EQ(refusal(), "no checkpoint that hemirad wrote: shots is not a count") << count;
    }
}

TEST_F(CheckpointFile, ReplacesNothingButCheckpoints) {
    EXPECT_NO_THROW(require_no_other_file(file_));
    put("");
    EXPECT_NO_THROW(require_no_other_file(file_));
    written();
    EXPECT_NO_THROW(require_no_other_file(file_));
    put("v 0 0 0\n");
    EXPECT_THROW(require_no_other_file(file_), InputError);
}

/// What the file is said to be made with, where a solve of this identity asks for it.
std::string difference_to(const SolveIdentity& solve, double tolerance = 1e-3,
                          std::uint64_t max_shots = 42) {
    try {
        require_same_solve("a.ckpt", checkpoint(), solve, tolerance, max_shots);
    } catch (const InputError& fault) {
        return fault.what();
    }
    return "";
}

TEST(CheckpointOf, TheSameSolveIsTaken) {
    EXPECT_EQ(difference_to(identity()), "");
    EXPECT_EQ(difference_to(identity(), 1e-4, 1000), "");
    EXPECT_EQ(doubt("a.ckpt", checkpoint(), identity()), std::nullopt);
}

TEST(CheckpointOf, AnotherSolveIsRefusedByItsDifference) {
    auto other = identity();
    other.settings[1].second = "1";
    EXPECT_EQ(difference_to(other), "a.ckpt: made with --salvo 8, not 1");
    other = identity();
    other.settings.emplace_back("--new", "1");
    EXPECT_EQ(difference_to(other), "a.ckpt: made before there was --new");
    other = identity();
    other.version = "2.0.0";
    EXPECT_EQ(difference_to(other), "a.ckpt: made by hemirad 1.2.3, not 2.0.0");
    other = identity();
    other.scene = "changed";
    EXPECT_EQ(difference_to(other),
              "a.ckpt: made from another scene, or before this one was changed");
    other = identity();
    other.mesh = "changed";
    EXPECT_EQ(difference_to(other), "a.ckpt: made with another mesh of the same scene");
    other = identity();
    other.kernels = "changed";
    EXPECT_EQ(difference_to(other), "a.ckpt: made with other kernels");
}

TEST(CheckpointOf, ASolveThatWouldHaveEndedBeforeIsRefused) {
    EXPECT_EQ(difference_to(identity(), 1e-2),
              "a.ckpt: made with --tolerance 0.001, not as much as 0.01");
    EXPECT_EQ(difference_to(identity(), 1e-3, 41),
              "a.ckpt: made after 42 shots, more than --max-shots 41");
}

TEST_F(CheckpointFile, OfADeviceWhoseNameIsNoUtf8IsNotDoubtedOnIt) {
    auto made = checkpoint();
    made.made_with.device = "Ger\xe4t \xff";
    write_checkpoint(file_, made);

    EXPECT_EQ(doubt(file_, read_checkpoint(file_), made.made_with), std::nullopt);
}

TEST(CheckpointOf, AnotherDeviceIsDoubted) {
    auto other = identity();
    other.device = "abacus";

    EXPECT_EQ(difference_to(other), "");
    EXPECT_EQ(
        doubt("a.ckpt", checkpoint(), other),
        "a.ckpt: made on device, not abacus: the last bits may be other than those of a solve "
        "that never stopped");
}

}  // namespace
}  // namespace hemirad::checkpoint_file_test
