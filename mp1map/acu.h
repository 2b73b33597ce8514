#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mp1map/device.h"
#include "mp1map/plural.h"
#include "mp1map/program.h"

namespace mp1map {

/// How many work-items run a kernel, in groups of `local`.
struct Grid {
    std::size_t groups = 1;
    std::size_t local = 1;
};

/// The array control unit (sec. 1.4): the host's side of the machine. It issues kernels to the PE
/// array in order, moves plural variables in and out, and keeps the device's clock.
/// Every failing call throws DeviceError with the name of what failed, a group larger than the
/// device takes NoSuchDevice.
class Acu {
  public:
    /// `timed`: keep the seconds every kernel took (costs an event a launch).
    Acu(const Device& device, bool timed);

    /// `size` elements of T on the device, all bits zero.
    template <class T>
    Plural<T> plural(std::size_t size) {
        // An empty buffer is an error in OpenCL; one element stands in for it.
        const std::size_t bytes = std::max<std::size_t>(size, 1) * sizeof(T);
        allocated_bytes_ += bytes;
        return Plural<T>(zeroed(bytes), size);
    }
    /// The same, but of unknown bits: memory that is never written may never be taken.
    template <class T>
    Plural<T> unset_plural(std::size_t size) {
        const std::size_t bytes = std::max<std::size_t>(size, 1) * sizeof(T);
        allocated_bytes_ += bytes;
        return Plural<T>(allocated(bytes), size);
    }
    template <class T>
    Plural<T> plural(const std::vector<T>& values) {
        auto result = plural<T>(values.size());
        load(result, std::span<const T>(values));
        return result;
    }
    template <class T>
    void load(Plural<T>& to, std::span<const T> values) {
        write(to.buffer(), values.data(), values.size_bytes());
    }
    /// The first words of the first element, a power of two of them and at most 32, without
    /// waiting: as a pattern they are copied at once, which values in the host's memory are not.
    template <std::size_t words, class T>
    void load_words(Plural<T>& to, const T& value) {
        std::array<cl_uint, words> pattern;
        std::memcpy(pattern.data(), &value, sizeof(pattern));
        guarded("load",
                [&] { queue_.enqueueFillBuffer(to.buffer(), pattern, 0, sizeof(pattern)); });
    }
    template <class T>
    void clear(Plural<T>& to) {
        fill_zero(to.buffer(), to.size() * sizeof(T));
    }
    /// Waits for all that was issued before.
    template <class T>
    std::vector<T> unload(const Plural<T>& from) {
        std::vector<T> values(from.size());
        read(from.buffer(), values.data(), values.size() * sizeof(T));
        return values;
    }

    /// Arguments: Plural<T>, or a scalar of OpenCL's size.
    template <class... Args>
    void issue(Kernel& kernel, Grid grid, const Args&... args) {
        cl_uint index = 0;
        guarded(kernel.name, [&] { (set(kernel, index++, args), ...); });
        launch(kernel, grid);
    }

    void flush();
    void wait();

    std::uint64_t allocated_bytes() const { return allocated_bytes_; }  ///< by plural(), in all
    /// Seconds and launches a kernel, by name; waits for these first. Empty unless timed.
    const std::map<std::string, std::pair<double, std::uint64_t>>& kernel_seconds();
    void forget_seconds();

  private:
    template <class T>
    static void set(Kernel& kernel, cl_uint index, const Plural<T>& value) {
        kernel.handle.setArg(index, value.buffer());
    }
    template <class T>
    static void set(Kernel& kernel, cl_uint index, const T& value) {
        kernel.handle.setArg(index, value);
    }
    template <class Call>
    void guarded(const std::string& name, Call&& call) {
        try {
            call();
        } catch (const cl::Error& error) {
            fail(name, error);
        } catch (const std::bad_alloc&) {  // of PoCL's compiler: see built() of program.cpp
            std::terminate();
        }
    }
    [[noreturn]] void fail(const std::string& name, const cl::Error& error) const;
    cl::Buffer allocated(std::size_t bytes);
    void ask_for_huge_pages(const cl::Buffer& buffer, std::size_t bytes);
    cl::Buffer zeroed(std::size_t bytes);
    void fill_zero(const cl::Buffer& buffer, std::size_t bytes);
    void write(const cl::Buffer& buffer, const void* values, std::size_t bytes);
    void read(const cl::Buffer& buffer, void* values, std::size_t bytes);
    void require_group(const Kernel& kernel, std::size_t work_items) const;
    void launch(Kernel& kernel, Grid grid);
    void collect();

    cl::Context context_;
    cl::CommandQueue queue_;
    std::string device_name_;
    std::uint64_t allocated_bytes_ = 0;
    bool is_cpu_ = false, timed_ = false;
    std::vector<std::pair<std::string, cl::Event>> pending_;
    std::map<std::string, std::pair<double, std::uint64_t>> seconds_;
};

}  // namespace mp1map
