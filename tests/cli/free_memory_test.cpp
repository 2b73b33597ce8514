#include "cli/free_memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace hemirad::free_memory_test {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;

/// A machine of 8,192 MiB, of which 4,096 are free, and files of the kernel's made up.
class FreeMemory : public testing::Test {
  protected:
    FreeMemory() {
        put("proc/meminfo", "MemTotal: 8388608 kB\nMemAvailable: 4194304 kB\nSwapFree: 0 kB\n");
    }
    ~FreeMemory() override { std::filesystem::remove_all(root_); }

    void put(const std::filesystem::path& file, const std::string& text) {
        std::filesystem::create_directories((root_ / file).parent_path());
        std::ofstream(root_ / file) << text;
    }

    void put_group_2(const std::filesystem::path& group, const std::string& limit,
                     std::uint64_t used, std::uint64_t unused_files) {
        put(group / "memory.max", limit + "\n");
        put(group / "memory.current", std::to_string(used) + "\n");
        put(group / "memory.stat", "anon 7\nfile 99\ninactive_anon 7\ninactive_file " +
                                       std::to_string(unused_files) + "\nactive_file 8\n");
    }

    void put_group_1(const std::filesystem::path& group, std::uint64_t limit, std::uint64_t used,
                     std::uint64_t unused_files) {
        put(group / "memory.limit_in_bytes", std::to_string(limit) + "\n");
        put(group / "memory.usage_in_bytes", std::to_string(used) + "\n");
        put(group / "memory.stat",
            "inactive_file 5\ntotal_inactive_file " + std::to_string(unused_files) + "\n");
    }

    std::uint64_t free_mib() const { return free_memory(root_) / kMiB; }

    std::filesystem::path root_ =
        std::filesystem::path(testing::TempDir()) / ("hemirad-free-" + std::to_string(getpid()));
};

TEST_F(FreeMemory, IsTheMachinesWhereNoGroupHasALimit) {
    put("proc/self/cgroup", "0::/\n");
    EXPECT_EQ(free_mib(), 4096);
    put_group_2("sys/fs/cgroup", "max", 7000 * kMiB, 0);
    EXPECT_EQ(free_mib(), 4096);
}

TEST_F(FreeMemory, HoldsFreeSwap) {
    put("proc/meminfo", "MemAvailable: 4194304 kB\nSwapFree: 1048576 kB\n");
    EXPECT_EQ(free_mib(), 5120);
}

TEST_F(FreeMemory, HasNoEndWhereNothingIsTold) {
    put("proc/meminfo", "MemTotal: 8388608 kB\n");
    EXPECT_GT(free_memory(root_), std::uint64_t{1} << 60);
}

TEST_F(FreeMemory, IsWhatAGroupHasLeft) {
    put("proc/self/cgroup", "0::/\n");
    put_group_2("sys/fs/cgroup", std::to_string(1000 * kMiB), 300 * kMiB, 0);
    EXPECT_EQ(free_mib(), 700);
}

TEST_F(FreeMemory, HoldsTheFilesThatAGroupHasReadAndDoesNotUse) {
    put("proc/self/cgroup", "0::/\n");
    put_group_2("sys/fs/cgroup", std::to_string(1000 * kMiB), 900 * kMiB, 800 * kMiB);
    EXPECT_EQ(free_mib(), 900);
}

TEST_F(FreeMemory, IsNothingInAGroupBeyondItsLimit) {
    put("proc/self/cgroup", "0::/\n");
    put_group_2("sys/fs/cgroup", std::to_string(100 * kMiB), 101 * kMiB, 0);
    EXPECT_EQ(free_mib(), 0);
    put_group_2("sys/fs/cgroup", std::to_string(100 * kMiB), 50 * kMiB, 51 * kMiB);
    EXPECT_EQ(free_mib(), 100);
}

TEST_F(FreeMemory, IsThatOfTheTightestOfNestedGroups) {
    put("proc/self/cgroup", "0::/user.slice/user-7.slice/solve.scope\n");
    put_group_2("sys/fs/cgroup/user.slice", std::to_string(3000 * kMiB), 0, 0);
    put_group_2("sys/fs/cgroup/user.slice/user-7.slice", std::to_string(2000 * kMiB), kMiB, 0);
    put_group_2("sys/fs/cgroup/user.slice/user-7.slice/solve.scope", "max", kMiB, 0);
    EXPECT_EQ(free_mib(), 1999);
    put_group_2("sys/fs/cgroup/user.slice", std::to_string(3000 * kMiB), 2500 * kMiB, 0);
    EXPECT_EQ(free_mib(), 500);
}

TEST_F(FreeMemory, IsNotThatOfAGroupBeside) {
    put("proc/self/cgroup", "0::/a/b\n");
    put_group_2("sys/fs/cgroup/a", std::to_string(1000 * kMiB), 0, 0);
    put_group_2("sys/fs/cgroup/a/c", std::to_string(10 * kMiB), 0, 0);
    put_group_2("sys/fs/cgroup/b", std::to_string(10 * kMiB), 0, 0);
    EXPECT_EQ(free_mib(), 1000);
}

TEST_F(FreeMemory, IsThatOfVersionOnesGroups) {
    put("proc/self/cgroup", "9:name=systemd:/x\n5:cpu,memory:/docker/7f\n0::/y\n");
    put_group_1("sys/fs/cgroup/memory", 9223372036854771712u, 5000 * kMiB, 0);
    put_group_1("sys/fs/cgroup/memory/docker/7f", 1000 * kMiB, 700 * kMiB, 600 * kMiB);
    EXPECT_EQ(free_mib(), 900);
    put_group_1("sys/fs/cgroup/memory/docker", 500 * kMiB, 300 * kMiB, 0);
    EXPECT_EQ(free_mib(), 200);
}

TEST_F(FreeMemory, IsThatOfAContainerWhoseGroupIsMountedAsTheRoot) {
    put("proc/self/cgroup", "4:memory:/docker/7f\n");
    put_group_1("sys/fs/cgroup/memory", 1000 * kMiB, 100 * kMiB, 0);
    EXPECT_EQ(free_mib(), 900);
    put("proc/self/cgroup", "0::/../../7f\n");
    put_group_2("sys/fs/cgroup", std::to_string(800 * kMiB), 100 * kMiB, 0);
    EXPECT_EQ(free_mib(), 700);
}

TEST_F(FreeMemory, OfThisMachineIsLessThanItHas) {
    EXPECT_GT(free_memory(), kMiB);
    EXPECT_LT(free_memory(), std::uint64_t{1} << 50);
}

}  // namespace
}  // namespace hemirad::free_memory_test
