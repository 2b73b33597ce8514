#include "mp1map/device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

namespace mp1map::device_test {
namespace {

// What `call` throws, as text; empty where it throws nothing of that kind.
template <class Error, class Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

TEST(Device, EveryDeviceIsListedUnderItsIndexWithWhatItSaysOfItself) {
    const auto devices = list_devices();

    ASSERT_FALSE(devices.empty()) << "no OpenCL device";
    for (std::size_t i = 0; i < devices.size(); ++i) {
        EXPECT_EQ(devices[i].index, i);
        EXPECT_FALSE(devices[i].name.empty());
        EXPECT_FALSE(devices[i].platform.empty());
        EXPECT_EQ(devices[i].version.substr(0, 7), "OpenCL ");
        EXPECT_GE(devices[i].compute_units, 1u);
        EXPECT_GE(devices[i].max_work_group, 1u);
        EXPECT_GE(devices[i].native_lanes, 1u);
        EXPECT_GT(devices[i].local_memory, 0u);
        EXPECT_GT(devices[i].global_memory, 0u);
    }
}

TEST(Device, WithoutASelectorAPoclCpuComesFirst) {
    const auto devices = list_devices();
    const auto pocl = std::find_if(devices.begin(), devices.end(), [](const auto& device) {
        return device.is_cpu && device.platform == "Portable Computing Language";
    });
    ASSERT_NE(pocl, devices.end()) << "the tests need PoCL";

    EXPECT_EQ(Device::open("").summary().index, pocl->index);
}

TEST(Device, AnIndexSelectsThatDevice) {
    for (const auto& device : list_devices())
        EXPECT_EQ(Device::open(std::to_string(device.index)).summary().index, device.index);
}

TEST(Device, APartOfTheNameOrThePlatformSelectsInEitherCase) {
    const auto first = list_devices().front();

    EXPECT_EQ(Device::open(upper(first.name.substr(1, 6))).summary().name, first.name);
    EXPECT_EQ(Device::open(upper(first.platform)).summary().platform, first.platform);
}

TEST(Device, AnUnknownSelectorNamesItselfAndTheDevicesThereAre) {
    for (const std::string selector : {"no such chip", "4711", "-1", "0x"}) {
        const auto message = message_of<NoSuchDevice>([&] { Device::open(selector); });

        EXPECT_NE(message.find('"' + selector + '"'), std::string::npos) << message;
        EXPECT_NE(message.find(list_devices().front().name), std::string::npos) << message;
    }
}

TEST(Device, OneComputeUnitIsASubDeviceOfOne) {
    if (!Device::open("").summary().is_divisible) GTEST_SKIP() << "a device without parts";

    EXPECT_EQ(Device::open("", 1).summary().compute_units, 1u);
}

TEST(Device, AllComputeUnitsAreTheDeviceItself) {
    const auto units = Device::open("").summary().compute_units;

    EXPECT_EQ(Device::open("", units).summary().compute_units, units);
}

TEST(Device, MoreComputeUnitsThanThereAreIsNoSuchDevice) {
    const auto units = Device::open("").summary().compute_units + 1;

    const auto message = message_of<NoSuchDevice>([&] { Device::open("", units); });

    EXPECT_NE(message.find("--compute-units " + std::to_string(units)), std::string::npos)
        << message;
}

}  // namespace
}  // namespace mp1map::device_test
