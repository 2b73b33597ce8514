#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "mp1map/opencl.h"

namespace mp1map {

/// The device, its driver or its compiler failed. Exit code 2.
struct DeviceError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// No device answers to what the user asked for. Exit code 1.
struct NoSuchDevice : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// E.g. `clFinish failed with OpenCL error -5 (out of resources)`.
std::string failure_text(const cl::Error& error);

/// The same of an OpenCL call that nobody asked what it was for; empty of other exceptions.
std::string failure_text(const std::exception& fault);

/// Kernels that add up a fixed number of sums do so in one group of that many work-items.
inline constexpr std::size_t kLeastWorkGroup = 64;

/// What an OpenCL device says of itself.
struct DeviceSummary {
    std::size_t index = 0;
    std::string platform, name, version;
    bool is_cpu = false;
    std::uint32_t compute_units = 0;
    std::uint32_t native_lanes = 1;  ///< its preferred float vector width
    std::size_t max_work_group = 0;  ///< work-items
    std::uint64_t local_memory = 0, global_memory = 0, max_allocation = 0;  ///< bytes
    bool is_divisible = false;  ///< into devices of fewer compute units
    std::string lacks;  ///< why it cannot be used, e.g. `has no compiler`; empty where it can
};

/// All devices of all platforms, in the order that `--device INDEX` counts. Empty where there is
/// no OpenCL driver.
std::vector<DeviceSummary> list_devices();

/// An OpenCL device, or `compute_units` of its units, with a context of its own.
class Device {
  public:
    /// `selector`: an index, a part of the name or platform, or empty for the first PoCL CPU, else
    /// the first CPU, else the first device, of those that lack nothing. `compute_units` 0: all of
    /// them. Throws NoSuchDevice, or DeviceError where the device lacks something, or cannot be
    /// opened or divided.
    static Device open(const std::string& selector, std::uint32_t compute_units = 0);

    const DeviceSummary& summary() const { return summary_; }
    const cl::Device& handle() const { return device_; }
    const cl::Context& context() const { return context_; }

  private:
    Device(cl::Device device, DeviceSummary summary);

    cl::Device device_;
    cl::Context context_;
    DeviceSummary summary_;
};

}  // namespace mp1map
