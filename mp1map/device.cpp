#include "mp1map/device.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <tuple>

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

// The version as a device gives it: "OpenCL 1.2 ...".
bool is_older_than_1_2(const std::string& version) {
    int major = 0, minor = 0;
    const std::string_view begin = "OpenCL ";
    if (!version.starts_with(begin)) return false;
    const auto* const end = version.data() + version.size();
    const auto parsed = std::from_chars(version.data() + begin.size(), end, major);
    if (parsed.ptr < end) std::from_chars(parsed.ptr + 1, end, minor);
    return std::tie(major, minor) < std::make_tuple(1, 2);
}

std::string what_lacks(const cl::Device& device, const DeviceSummary& summary) {
    if (device.getInfo<CL_DEVICE_AVAILABLE>() == CL_FALSE) return "is not available";
    if (device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE) return "has no compiler";
    if (is_older_than_1_2(summary.version)) return "is of " + summary.version + "; it takes 1.2";
    if (summary.max_work_group < kLeastWorkGroup)
        return "takes " + std::to_string(summary.max_work_group) +
               " work-items a group; it takes " + std::to_string(kLeastWorkGroup);
    return {};
}

bool is_divisible(const cl::Device& device) {
    const auto ways = device.getInfo<CL_DEVICE_PARTITION_PROPERTIES>();
    return std::ranges::find(ways, CL_DEVICE_PARTITION_BY_COUNTS) != ways.end();
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
    summary.is_divisible = is_divisible(device);
    summary.lacks = what_lacks(device, summary);
    return summary;
}

constexpr cl_int kNoPlatform = -1001;  // cl_khr_icd: the loader knows of no driver

std::vector<Found> find_devices() {
    provide_compile_cache();
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error& error) {
        if (error.err() == kNoPlatform) return {};
        throw;
    }
    std::vector<Found> found;
    for (const auto& platform : platforms) {
        const auto name = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error& error) {
            if (error.err() == CL_DEVICE_NOT_FOUND) continue;
            throw;
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
    const auto merit = [](const Found& one) {
        if (!one.summary.lacks.empty()) return 0;
        if (!one.summary.is_cpu) return 1;
        return lower(one.summary.platform).find("portable") == std::string::npos ? 2 : 3;
    };
    return *std::ranges::max_element(found, {}, merit);  // the first of the best
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

std::string meaning(cl_int error) {
    switch (error) {
        case CL_DEVICE_NOT_AVAILABLE:
            return " (device not available)";
        case CL_COMPILER_NOT_AVAILABLE:
            return " (no compiler)";
        case CL_MEM_OBJECT_ALLOCATION_FAILURE:
        case CL_OUT_OF_HOST_MEMORY:
        case CL_MAP_FAILURE:
            return " (out of memory)";
        case CL_OUT_OF_RESOURCES:
            return " (out of resources)";
        case CL_INVALID_BUFFER_SIZE:
            return " (out of memory for one buffer)";
        case CL_INVALID_WORK_GROUP_SIZE:
            return " (work-group too large: lower --pe)";
        default:
            return "";
    }
}

}  // namespace

std::string failure_text(const cl::Error& error) {
    return std::string(error.what()) + " failed with OpenCL error " + std::to_string(error.err()) +
           meaning(error.err());
}

std::string failure_text(const std::exception& fault) {
    const auto* const error = dynamic_cast<const cl::Error*>(&fault);
    return error == nullptr ? "" : failure_text(*error);
}

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
    if (!summary.lacks.empty()) throw DeviceError(summary.name + " " + summary.lacks);
    if (compute_units > summary.compute_units)
        throw NoSuchDevice("--compute-units " + std::to_string(compute_units) + ": " +
                           summary.name + " has " + std::to_string(summary.compute_units));
    const bool is_part = compute_units != 0 && compute_units < summary.compute_units;
    if (is_part && !summary.is_divisible)
        throw NoSuchDevice("--compute-units " + std::to_string(compute_units) + ": " +
                           summary.name + " cannot be divided");
    try {
        if (is_part) {
            device = divided(device, compute_units);
            summary.compute_units = compute_units;
        }
        return Device(device, summary);
    } catch (const cl::Error& error) {
        throw DeviceError(summary.name + ": " + failure_text(error));
    }
}

}  // namespace mp1map
