#include "mp1map/device.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "mp1map/compile_cache.h"

namespace mp1map {
namespace {

struct Found {
    cl::Device device;
    DeviceSummary summary;
};

// Drivers pad names with blanks and end them with a NUL.
std::string trimmed(std::string text) {
    const auto blank = [](unsigned char c) { return c == 0 || std::isspace(c) != 0; };
    while (!text.empty() && blank(text.back())) text.pop_back();
    text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), blank));
    return text;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

DeviceSummary summarise(const cl::Device& device, const std::string& platform, std::size_t index) {
    DeviceSummary summary;
    summary.index = index;
    summary.platform = platform;
    summary.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    summary.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    summary.is_cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
    summary.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    summary.native_lanes = std::max(1u, device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>());
    summary.max_work_group = device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
    summary.local_memory = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    summary.global_memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    summary.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    return summary;
}

std::vector<Found> find_devices() {
    provide_compile_cache();
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        return {};  // the loader says "no platform" by an error
    }
    std::vector<Found> found;
    for (const auto& platform : platforms) {
        const auto name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error&) {
            continue;  // a platform without a device says so by an error
        }
        for (const auto& device : devices)
            found.push_back({device, summarise(device, name, found.size())});
    }
    return found;
}

std::string names_of(const std::vector<Found>& found) {
    std::string names;
    for (const auto& [device, summary] : found)
        names += (names.empty() ? "" : ", ") + std::to_string(summary.index) + ": " + summary.name;
    return names;
}

const Found& first_choice(const std::vector<Found>& found) {
    const auto pocl_cpu = [](const Found& one) {
        return one.summary.is_cpu &&
               lower(one.summary.platform).find("portable") != std::string::npos;
    };
    const auto cpu = [](const Found& one) { return one.summary.is_cpu; };
    if (const auto it = std::find_if(found.begin(), found.end(), pocl_cpu); it != found.end())
        return *it;
    if (const auto it = std::find_if(found.begin(), found.end(), cpu); it != found.end())
        return *it;
    return found.front();
}

const Found& choose(const std::vector<Found>& found, const std::string& selector) {
    if (found.empty())
        throw DeviceError("no OpenCL device found; on Debian: apt-get install pocl-opencl-icd");
    if (selector.empty()) return first_choice(found);

    std::size_t index = 0;
    const auto* end = selector.data() + selector.size();
    const auto parsed = std::from_chars(selector.data(), end, index);
    const bool is_index = parsed.ec == std::errc() && parsed.ptr == end;
    if (is_index && index < found.size()) return found[index];
    for (const auto& one : found)
        if (!is_index &&
            lower(one.summary.platform + " " + one.summary.name).find(lower(selector)) !=
                std::string::npos)
            return one;
    throw NoSuchDevice("--device \"" + selector + "\": no such device; there is " +
                       names_of(found));
}

// `units` compute units of a device, as a sub-device.
cl::Device divided(cl::Device device, std::uint32_t units) {
    const std::array<cl_device_partition_property, 4> by_counts = {
        CL_DEVICE_PARTITION_BY_COUNTS, static_cast<cl_device_partition_property>(units),
        CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    device.createSubDevices(by_counts.data(), &parts);
    // PoCL 3.1 would free it while one of its threads still releases the last event.
    clRetainDevice(parts.front()());
    return parts.front();
}

}  // namespace

std::vector<DeviceSummary> list_devices() {
    std::vector<DeviceSummary> summaries;
    for (auto& one : find_devices()) summaries.push_back(std::move(one.summary));
    return summaries;
}

Device::Device(cl::Device device, DeviceSummary summary)
    : device_(std::move(device)), context_(device_), summary_(std::move(summary)) {}

Device Device::open(const std::string& selector, std::uint32_t compute_units) {
    const auto found = find_devices();
    auto [device, summary] = choose(found, selector);
    if (compute_units > summary.compute_units)
        throw NoSuchDevice("--compute-units " + std::to_string(compute_units) + ": " +
                           summary.name + " has " + std::to_string(summary.compute_units));
    try {
        if (compute_units != 0 && compute_units < summary.compute_units) {
            device = divided(device, compute_units);
            summary.compute_units = compute_units;
        }
        return Device(device, summary);
    } catch (const cl::Error& error) {
        throw DeviceError(summary.name + ": " + error.what() + " failed with OpenCL error " +
                          std::to_string(error.err()));
    }
}

}  // namespace mp1map
