#include "mp1map/acu.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <cstdint>

namespace mp1map {

namespace {
constexpr std::size_t kPendingEvents = 4096;  // read back in blocks: an event holds host memory
// Below, what the first touches of small pages cost does not matter.
constexpr std::size_t kHugePage = std::size_t{2} << 20, kLeastHuge = 4 * kHugePage;
}  // namespace

Acu::Acu(const Device& device, bool timed)
    : context_(device.context()),
      device_name_(device.summary().name),
      is_cpu_(device.summary().is_cpu),
      timed_(timed) {
    guarded("command queue", [&] {
        // cl::CommandQueue calls a function of OpenCL 2.0, which drivers of 1.2 do not have.
        cl_int error = CL_SUCCESS;
        queue_ = cl::CommandQueue(clCreateCommandQueue(
            device.context()(), device.handle()(),
            timed ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{}, &error));
        if (error != CL_SUCCESS) throw cl::Error(error, "clCreateCommandQueue");
    });
}

void Acu::fail(const std::string& name, const cl::Error& error) const {
    throw DeviceError(device_name_ + ": " + name + ": " + failure_text(error));
}

cl::Buffer Acu::allocated(std::size_t bytes) {
    cl::Buffer buffer;
    const bool huge = is_cpu_ && bytes >= kLeastHuge;
    // PoCL 3.1 allocates the host's memory at once, and else when it is first used, where it aborts
    // if there is none.
    const cl_mem_flags where = huge ? CL_MEM_ALLOC_HOST_PTR : cl_mem_flags{};
    guarded("allocation of " + std::to_string(bytes) + " bytes", [&] {
        buffer = cl::Buffer(context_, CL_MEM_READ_WRITE | where, bytes);
        if (huge) ask_for_huge_pages(buffer, bytes);
    });
    return buffer;
}

// A buffer of a CPU is the host's memory. On a virtual machine the first touch of a page was
// measured to take 12 us, of 1 GiB in small pages 3.2 s, in huge ones 0.04 to 1.2 s.
void Acu::ask_for_huge_pages([[maybe_unused]] const cl::Buffer& buffer,
                             [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
    void* const memory =
        queue_.enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
    const auto begin = reinterpret_cast<std::uintptr_t>(memory);
    const auto first = (begin + kHugePage - 1) / kHugePage * kHugePage;
    const auto end = (begin + bytes) / kHugePage * kHugePage;
    madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);  // only advice
    queue_.enqueueUnmapMemObject(buffer, memory);
#endif
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

// A device may take fewer work-items of a kernel than of others: its registers are shared.
void Acu::require_group(const Kernel& kernel, std::size_t work_items) const {
    if (work_items <= kernel.most_work_items) return;
    throw NoSuchDevice(device_name_ + ": " + kernel.name + ": takes at most " +
                       std::to_string(kernel.most_work_items) + " work-items a group, not " +
                       std::to_string(work_items) + ": lower --pe");
}

void Acu::launch(Kernel& kernel, Grid grid) {
    require_group(kernel, grid.local);
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
    if (pending_.empty()) return;
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

void Acu::forget_seconds() {
    collect();
    seconds_.clear();
}

}  // namespace mp1map
