#include "mp1map/acu.h"

namespace mp1map {

namespace {
constexpr std::size_t kPendingEvents = 4096;  // read back in blocks: an event holds host memory
}

Acu::Acu(const Device& device, bool timed)
    : context_(device.context()), device_name_(device.summary().name), timed_(timed) {
    guarded("command queue", [&] {
        queue_ =
            cl::CommandQueue(device.context(), device.handle(),
                             timed ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{});
    });
}

void Acu::fail(const std::string& name, const cl::Error& error) const {
    const bool memory =
        error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
        error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE;
    throw DeviceError(device_name_ + ": " + name + ": " + error.what() +
                      " failed with OpenCL error " + std::to_string(error.err()) +
                      (memory ? " (out of memory)" : ""));
}

cl::Buffer Acu::allocated(std::size_t bytes) {
    cl::Buffer buffer;
    guarded("allocation of " + std::to_string(bytes) + " bytes",
            [&] { buffer = cl::Buffer(context_, CL_MEM_READ_WRITE, bytes); });
    return buffer;
}

cl::Buffer Acu::zeroed(std::size_t bytes) {
    const cl::Buffer buffer = allocated(bytes);
    fill_zero(buffer, bytes);
    return buffer;
}

void Acu::fill_zero(const cl::Buffer& buffer, std::size_t bytes) {
    if (bytes == 0) return;
    guarded("clear", [&] { queue_.enqueueFillBuffer(buffer, cl_uchar{0}, 0, bytes); });
}

void Acu::write(const cl::Buffer& buffer, const void* values, std::size_t bytes) {
    if (bytes == 0) return;
    guarded("load", [&] { queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, values); });
}

void Acu::read(const cl::Buffer& buffer, void* values, std::size_t bytes) {
    if (bytes == 0) return;
    guarded("unload", [&] { queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, bytes, values); });
}

void Acu::launch(Kernel& kernel, Grid grid) {
    guarded(kernel.name, [&] {
        cl::Event event;
        queue_.enqueueNDRangeKernel(kernel.handle, cl::NullRange,
                                    cl::NDRange(grid.groups * grid.local), cl::NDRange(grid.local),
                                    nullptr, timed_ ? &event : nullptr);
        if (timed_) pending_.emplace_back(kernel.name, std::move(event));
    });
    if (pending_.size() >= kPendingEvents) collect();
}

void Acu::flush() {
    guarded("flush", [&] { queue_.flush(); });
}

void Acu::wait() {
    guarded("finish", [&] { queue_.finish(); });
}

void Acu::collect() {
    wait();
    guarded("profiling", [&] {
        for (const auto& [name, event] : pending_) {
            const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
            const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            auto& [seconds, launches] = seconds_[name];
            seconds += 1e-9 * static_cast<double>(end - start);
            ++launches;
        }
    });
    pending_.clear();
}

const std::map<std::string, std::pair<double, std::uint64_t>>& Acu::kernel_seconds() {
    collect();
    return seconds_;
}

}  // namespace mp1map
