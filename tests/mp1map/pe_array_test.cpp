#include "mp1map/pe_array.h"

#include <gtest/gtest.h>

namespace mp1map::pe_array_test {
namespace {

DeviceSummary cpu(std::uint32_t native_lanes = 16) {
    DeviceSummary device;
    device.name = "a CPU";
    device.is_cpu = true;
    device.compute_units = 2;
    device.native_lanes = native_lanes;
    device.max_work_group = 4096;
    device.local_memory = 2 << 20;
    return device;
}

DeviceSummary gpu() {
    DeviceSummary device = cpu();
    device.name = "a GPU";
    device.is_cpu = false;
    device.native_lanes = 1;
    device.max_work_group = 1024;
    device.local_memory = 48 << 10;
    return device;
}

std::string refusal(const DeviceSummary& device, const PeArrayRequest& request) {
    try {
        fit_pe_array(device, request);
    } catch (const NoSuchDevice& error) {
        return error.what();
    }
    return {};
}

TEST(PeArray, ACpuGetsFewPesOfItsNativeWidthAndATileThatFitsItsCache) {
    const auto array = fit_pe_array(cpu(), {});

    EXPECT_EQ(array.description(), "2x1 PEs, 16 lanes, tile 32x32");
    EXPECT_EQ(array.layer_count(), 32u);
    EXPECT_EQ(array.bytes_per_pe(), 4096u);
}

TEST(PeArray, LanesAreTheWidestThatTheCpuHas) {
    EXPECT_EQ(fit_pe_array(cpu(32), {}).lanes, 16u);
    EXPECT_EQ(fit_pe_array(cpu(8), {}).lanes, 8u);
    EXPECT_EQ(fit_pe_array(cpu(4), {}).lanes, 4u);
    EXPECT_EQ(fit_pe_array(cpu(2), {}).lanes, 1u);
}

TEST(PeArray, AnAreaOfACpuIsOneRowOfATileWhateverItsLanes) {
    for (const std::uint32_t lanes : {1u, 4u, 8u, 16u})
        EXPECT_EQ(fit_pe_array(cpu(lanes), {}).area_width(), 32u);
}

TEST(PeArray, AGpuGetsManyPesOfOneLane) {
    EXPECT_EQ(fit_pe_array(gpu(), {}).description(), "32x8 PEs, 1 lane, tile 32x32");
}

TEST(PeArray, ADeviceOfSmallGroupsGetsFewerPes) {
    auto small = gpu();
    small.max_work_group = 64;
    EXPECT_EQ(fit_pe_array(small, {}).description(), "32x2 PEs, 1 lane, tile 32x32");

    PeArrayRequest request;
    request.height = 16;
    EXPECT_EQ(fit_pe_array(small, request).description(), "4x16 PEs, 1 lane, tile 32x32");
}

TEST(PeArray, WhatIsAskedForIsKept) {
    PeArrayRequest request;
    request.width = 32;
    request.height = 32;
    request.lanes = 1;
    request.tile_width = 96;
    request.tile_height = 64;

    const auto array = fit_pe_array(cpu(), request);

    EXPECT_EQ(array.description(), "32x32 PEs, 1 lane, tile 96x64");
    EXPECT_EQ(array.layer_count(), 6u);
    EXPECT_EQ(array.bytes_per_pe(), 6u * 8);
}

TEST(PeArray, ATileIsRoundedUpToWholeAreas) {
    PeArrayRequest request;
    request.width = 3;
    request.height = 5;
    request.lanes = 4;
    request.tile_width = 13;
    request.tile_height = 6;

    const auto array = fit_pe_array(cpu(), request);

    EXPECT_EQ(array.tile_width, 24u);
    EXPECT_EQ(array.tile_height, 10u);
}

TEST(PeArray, ATileIsAtLeastAnArea) {
    PeArrayRequest request;
    request.width = 64;
    request.height = 32;
    request.lanes = 4;

    const auto array = fit_pe_array(cpu(), request);

    EXPECT_EQ(array.tile_width, 256u);
    EXPECT_EQ(array.tile_height, 32u);
}

TEST(PeArray, ThereIsAtLeastOneArrayToDealPatchesTo) {
    PeArrayRequest request;
    request.width = request.height = 64;
    request.lanes = 1;

    EXPECT_EQ(fit_pe_array(cpu(), request).array_count, 1u);
    EXPECT_GT(fit_pe_array(cpu(), {}).array_count, 1u);
    EXPECT_GT(fit_pe_array(gpu(), {}).array_count, 1u);
}

TEST(PeArray, LanesThatNoKernelHasAreRefused) {
    for (const std::uint32_t lanes : {2u, 3u, 5u, 32u}) {
        PeArrayRequest request;
        request.lanes = lanes;

        EXPECT_EQ(refusal(cpu(), request),
                  "--lanes " + std::to_string(lanes) + ": must be 1, 4, 8 or 16");
    }
}

TEST(PeArray, MorePesThanAWorkGroupTakesAreRefused) {
    PeArrayRequest request;
    request.width = 128;
    request.height = 128;
    request.lanes = 1;

    const auto message = refusal(cpu(), request);

    EXPECT_EQ(message, "--pe 128x128: a CPU takes at most 4096 work-items a group");
}

TEST(PeArray, ATileBeyondTheLocalMemoryIsRefused) {
    PeArrayRequest request;
    request.tile_width = request.tile_height = 64;  // 32 KiB, and the broadcast's

    EXPECT_EQ(refusal(gpu(), request), "");
    request.tile_height = 96;  // all of it, and nothing left for the broadcast
    EXPECT_NE(refusal(gpu(), request), "");
    request.tile_height = 128;
    const auto message = refusal(gpu(), request);
    EXPECT_EQ(message.find("--tile 64x128: "), 0u) << message;
    EXPECT_NE(message.find("a GPU has 49152"), std::string::npos) << message;
}

}  // namespace
}  // namespace mp1map::pe_array_test
