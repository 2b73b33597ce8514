#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "mp1map/acu.h"
#include "solver/kernel_source.h"

/// One kernel alone on the default device: its inputs loaded by the test, not by other kernels.
namespace hemirad::test {

/// What a kernel is compiled for; a test sets those that its kernel reads.
struct KernelOptions {
    std::uint32_t lanes = 1, pe_width = 1, pe_height = 1, tile_width = 1, tile_height = 1;
    std::uint32_t resolution = 64, corners = 4, bands = 1, prefix_pes = 1, reduce_pes = 1;
    std::uint32_t salvo = 1, flux_spacing = 1;
    bool two_levels = false;

    std::string text() const {
        const auto define = [](const char* name, std::uint32_t value) {
            return std::string(" -D") + name + "=" + std::to_string(value);
        };
        return define("LANES", lanes) + define("PE_WIDTH", pe_width) +
               define("PE_HEIGHT", pe_height) + define("TILE_WIDTH", tile_width) +
               define("TILE_HEIGHT", tile_height) + define("RESOLUTION", resolution) +
               define("CORNERS", corners) + define("BANDS", bands) +
               define("PREFIX_PES", prefix_pes) + define("REDUCE_PES", reduce_pes) +
               define("SALVO", salvo) + define("FLUX_SPACING", flux_spacing) +
               (two_levels ? " -DTWO_LEVELS" : "");
    }
};

class KernelRun {
  public:
    /// kernels/NAME.cl.
    KernelRun(const std::string& name, const KernelOptions& options)
        : KernelRun(name, kernel_source(name), options) {}

    /// The kernel NAME of tests/probes/FILE.cl, which shows a .clh to a test.
    static KernelRun probe(const std::string& file, const std::string& name,
                           const KernelOptions& options) {
        const auto path = std::filesystem::path(HEMI_PROBES) / (file + ".cl");
        std::ifstream stream(path);
        if (!stream) throw std::runtime_error(path.string() + ": no such probe");
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        return KernelRun(name, resolve_includes(text, path.string()), options);
    }

    mp1map::Acu& acu() { return acu_; }

    template <class T>
    mp1map::Plural<T> plural(const std::vector<T>& values) {
        return acu_.plural(values);
    }
    /// As many work-items in groups that the device takes of this kernel: a GPU's share registers.
    mp1map::Grid fitting(mp1map::Grid grid) const {
        for (; grid.local > kernel_.most_work_items && grid.local % 2 == 0; grid.local /= 2)
            grid.groups *= 2;
        return grid;
    }
    template <class... Args>
    void issue(mp1map::Grid grid, const Args&... args) {
        acu_.issue(kernel_, grid, args...);
    }

  private:
    KernelRun(const std::string& name, const std::string& source, const KernelOptions& options)
        : device_(mp1map::Device::open("")),
          kernel_(mp1map::build_kernels(device_, {name}, source, options.text()).at(name)),
          acu_(device_, false) {}

    mp1map::Device device_;
    mp1map::Kernel kernel_;
    mp1map::Acu acu_;
};

/// Floats as integers, so that a comparison is one of bits and tells -0 from 0.
inline std::vector<std::uint32_t> bits(const std::vector<float>& values) {
    std::vector<std::uint32_t> result;
    for (const float value : values) result.push_back(std::bit_cast<std::uint32_t>(value));
    return result;
}

}  // namespace hemirad::test
