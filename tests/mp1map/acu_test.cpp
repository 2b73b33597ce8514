#include "mp1map/acu.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#include <numeric>

namespace mp1map::acu_test {
namespace {

constexpr const char* kSource = R"(
__kernel void add(__global int* values, int summand) {
    values[get_global_id(0)] += summand;
}
__kernel void number(__global int* values) {
    values[get_global_id(0)] = 1000 * get_group_id(0) + get_local_id(0);
}
)";

class AcuTest : public testing::Test {
  protected:
    Device device_ = Device::open("");
    std::map<std::string, Kernel> kernels_ = build_kernels(device_, {"add", "number"}, kSource, "");
    Acu acu_{device_, false};
};

TEST_F(AcuTest, WhatIsLoadedIsUnloaded) {
    std::vector<std::int32_t> values(1000);
    std::iota(values.begin(), values.end(), -500);

    const auto plural = acu_.plural(values);

    EXPECT_EQ(plural.size(), 1000u);
    EXPECT_EQ(acu_.unload(plural), values);
}

TEST_F(AcuTest, APluralBeginsAllZero) {
    EXPECT_EQ(acu_.unload(acu_.plural<float>(321)), std::vector<float>(321, 0.0f));
}

TEST_F(AcuTest, AClearedPluralIsAllZero) {
    auto plural = acu_.plural(std::vector<float>(17, 3.5f));

    acu_.clear(plural);

    EXPECT_EQ(acu_.unload(plural), std::vector<float>(17, 0.0f));
}

TEST_F(AcuTest, AnEmptyPluralIsUnloadedEmpty) {
    auto plural = acu_.plural<float>(0);

    acu_.load(plural, std::span<const float>());

    EXPECT_EQ(plural.size(), 0u);
    EXPECT_TRUE(acu_.unload(plural).empty());
}

TEST_F(AcuTest, KernelsRunInTheOrderOfTheirIssue) {
    auto plural = acu_.plural<std::int32_t>(6);

    acu_.issue(kernels_.at("number"), {2, 3}, plural);
    acu_.issue(kernels_.at("add"), {3, 2}, plural, std::int32_t{5});
    acu_.issue(kernels_.at("add"), {1, 6}, plural, std::int32_t{-7});

    EXPECT_EQ(acu_.unload(plural), (std::vector<std::int32_t>{-2, -1, 0, 998, 999, 1000}));
}

TEST_F(AcuTest, AllocatedBytesAreThoseOfAllPlurals) {
    acu_.plural<float>(10);
    acu_.plural<std::int32_t>(7);

    EXPECT_EQ(acu_.allocated_bytes(), 68u);
}

TEST_F(AcuTest, WithoutTimingThereAreNoSeconds) {
    auto plural = acu_.plural<std::int32_t>(4);

    acu_.issue(kernels_.at("number"), {1, 4}, plural);

    EXPECT_TRUE(acu_.kernel_seconds().empty());
}

TEST_F(AcuTest, TimingCountsTheLaunchesOfEachKernel) {
    Acu timed(device_, true);
    auto plural = timed.plural<std::int32_t>(4);

    timed.issue(kernels_.at("number"), {1, 4}, plural);
    for (int i = 0; i < 5000; ++i)  // more events than are kept at a time
        timed.issue(kernels_.at("add"), {1, 4}, plural, std::int32_t{1});

    const auto& seconds = timed.kernel_seconds();
    EXPECT_EQ(seconds.size(), 2u);
    EXPECT_EQ(seconds.at("number").second, 1u);
    EXPECT_EQ(seconds.at("add").second, 5000u);
    EXPECT_GT(seconds.at("add").first, 0.0);
    EXPECT_EQ(timed.unload(plural).front(), 5000);
}

TEST_F(AcuTest, ALaunchThatTheDeviceRefusesNamesTheKernelAndTheDevice) {
    auto plural = acu_.plural<std::int32_t>(1);
    const std::size_t too_many = device_.summary().max_work_group * 2;

    try {
        acu_.issue(kernels_.at("number"), {1, too_many}, plural);
        FAIL() << "no error";
    } catch (const NoSuchDevice& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find(device_.summary().name + ": number: takes at most "), 0u) << message;
        EXPECT_NE(message.find("lower --pe"), std::string::npos) << message;
    }
}

TEST_F(AcuTest, AnArgumentOfTheWrongSizeNamesTheKernel) {
    auto plural = acu_.plural<std::int32_t>(1);

    try {
        acu_.issue(kernels_.at("add"), {1, 1}, plural, std::int64_t{1});
        FAIL() << "no error";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find(": add: "), std::string::npos) << error.what();
    }
}

TEST_F(AcuTest, MoreMemoryThanTheDeviceGivesSaysSo) {
    const std::size_t too_many = device_.summary().max_allocation / sizeof(float) * 4;

    try {
        acu_.plural<float>(too_many);
        FAIL() << "no error";
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("out of memory"), std::string::npos)
            << error.what();
    }
}

// A sanitizer's own shadow memory is beyond any such limit.
#ifndef __SANITIZE_ADDRESS__
std::uint64_t address_space() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST_F(AcuTest, MemoryThatACpuLacksWhenItIsTouchedIsAFailedAllocation) {
    if (!device_.summary().is_cpu) GTEST_SKIP() << "a device with memory of its own";
    constexpr std::size_t kBytes = std::size_t{1} << 30;
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    const rlimit tight{address_space() + kBytes / 2, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);

    std::string message;
    try {
        acu_.plural<float>(kBytes / sizeof(float));
    } catch (const DeviceError& error) {
        message = error.what();
    }
    setrlimit(RLIMIT_AS, &before);

    EXPECT_NE(message.find("allocation of " + std::to_string(kBytes) + " bytes"), message.npos)
        << message;
    EXPECT_NE(message.find("out of memory"), message.npos) << message;
}
#endif

}  // namespace
}  // namespace mp1map::acu_test
