#include "mp1map/pe_array.h"

#include <algorithm>
#include <bit>

namespace mp1map {
namespace {

constexpr std::uint32_t kCpuTile =
    32;  // 12 KiB of roots, depth and owner stay in a first-level cache
constexpr std::uint32_t kBytesPerProxel = 8;  // depth and owner
constexpr std::uint32_t kBytesPerPatch = 80;  // projection parameters, and room on the X-net
constexpr std::uint32_t kSpareBytes = 2048;   // that drivers take for themselves
constexpr std::uint32_t kBatchPatches = 64;   // 4.5 KiB: two barriers a batch cost nothing then
constexpr std::uint32_t kCpuStacks = 256, kGpuStacks = 1024;  // PEs of all arrays
constexpr std::uint32_t kArraysPerUnit = 4;                   // enough to even out uneven stacks

std::uint32_t native_lanes(const DeviceSummary& device) {
    if (!device.is_cpu) return 1;
    for (const std::uint32_t lanes : {16u, 8u, 4u})
        if (device.native_lanes >= lanes) return lanes;
    return 1;
}

std::uint32_t rounded_up(std::uint32_t value, std::uint32_t step) {
    return (value + step - 1) / step * step;
}

// PEs in a row and in a column: what was asked for, the rest at most what a group takes.
void set_pes(const DeviceSummary& device, const PeArrayRequest& request, PeArray& array) {
    const std::uint32_t width = device.is_cpu ? kCpuTile / array.lanes : 32;
    const std::uint32_t height = device.is_cpu ? 1 : 8;
    const auto fitting = [&](std::uint32_t wanted, std::uint64_t others) {
        const auto most = std::max<std::uint64_t>(device.max_work_group / others, 1);
        return std::min<std::uint32_t>(wanted, std::bit_floor(std::min<std::uint64_t>(most, 1024)));
    };
    array.width = request.width != 0 ? request.width : fitting(width, std::max(request.height, 1u));
    array.height = request.height != 0 ? request.height : fitting(height, array.width);
}

void check_lanes(std::uint32_t lanes) {
    if (lanes != 1 && lanes != 4 && lanes != 8 && lanes != 16)
        throw NoSuchDevice("--lanes " + std::to_string(lanes) + ": must be 1, 4, 8 or 16");
}

void check_work_group(const DeviceSummary& device, const PeArray& array) {
    if (std::uint64_t{array.width} * array.height > device.max_work_group)
        throw NoSuchDevice("--pe " + std::to_string(array.width) + "x" +
                           std::to_string(array.height) + ": " + device.name + " takes at most " +
                           std::to_string(device.max_work_group) + " work-items a group");
}

void check_local_memory(const DeviceSummary& device, const PeArray& array) {
    const std::uint64_t bytes =
        std::uint64_t{array.tile_width} * array.tile_height * kBytesPerProxel;
    const std::uint64_t batch = std::uint64_t{array.broadcast_patches()} * kBytesPerPatch;
    if (bytes + batch + kSpareBytes > device.local_memory)
        throw NoSuchDevice("--tile " + std::to_string(array.tile_width) + "x" +
                           std::to_string(array.tile_height) + ": needs " + std::to_string(bytes) +
                           " bytes of local memory; " + device.name + " has " +
                           std::to_string(device.local_memory));
}

}  // namespace

std::uint32_t PeArray::broadcast_patches() const {
    if (broadcast == Broadcast::patch) return 1;
    return broadcast == Broadcast::level ? pe_count() : kBatchPatches;
}

std::uint32_t PeArray::proxel_place(std::uint32_t x, std::uint32_t y) const {
    const std::uint32_t columns = tile_width / area_width(), rows = tile_height / area_height();
    const bool cyclic = layout == Layout::cyclic;
    const std::uint32_t vector = x / lanes;
    const std::uint32_t pe_x = cyclic ? vector % width : vector / columns;
    const std::uint32_t pe_y = cyclic ? y % height : y / rows;
    const std::uint32_t area_x = cyclic ? vector / width : vector % columns;
    const std::uint32_t area_y = cyclic ? y / height : y % rows;
    const std::uint32_t layer = area_y * columns + area_x, pe = pe_y * width + pe_x;
    return (layer * pe_count() + pe) * lanes + x % lanes;
}

std::string PeArray::description() const {
    return std::to_string(width) + "x" + std::to_string(height) + " PEs, " + std::to_string(lanes) +
           (lanes == 1 ? " lane" : " lanes") + ", tile " + std::to_string(tile_width) + "x" +
           std::to_string(tile_height);
}

PeArray fit_pe_array(const DeviceSummary& device, const PeArrayRequest& request) {
    PeArray array;
    array.is_on_cpu = device.is_cpu;
    array.layout = request.layout;
    array.broadcast = request.broadcast;
    array.lanes = request.lanes != 0 ? request.lanes : native_lanes(device);
    check_lanes(array.lanes);
    set_pes(device, request, array);
    const std::uint32_t tile = device.is_cpu ? kCpuTile : 32;
    check_work_group(device, array);
    array.tile_width =
        rounded_up(request.tile_width != 0 ? request.tile_width : tile, array.area_width());
    array.tile_height =
        rounded_up(request.tile_height != 0 ? request.tile_height : tile, array.area_height());
    const std::uint32_t wanted = std::max(1u, device.compute_units) * kArraysPerUnit;
    // Large arrays have PEs enough in fewer of them; a stack of a few patches only costs bins.
    array.array_count =
        std::clamp((device.is_cpu ? kCpuStacks : kGpuStacks) / array.pe_count(), 1u, wanted);
    check_local_memory(device, array);
    return array;
}

}  // namespace mp1map
