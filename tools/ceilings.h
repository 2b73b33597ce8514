#pragma once

#include <cstdint>

#include <map>
#include <string>

#include "mp1map/acu.h"
#include "mp1map/program.h"

namespace hemirad {

/// What the device can do at most, measured on the spot with kernels of its own.
class Ceilings {
  public:
    explicit Ceilings(const mp1map::Device& device);

    /// Seconds of a streaming copy that reads half of so many bytes and writes the other half.
    double copy_seconds(std::uint64_t bytes);
    /// Floating-point operations a second of fused multiply-adds, two each.
    double flops();

  private:
    mp1map::Acu acu_;
    std::map<std::string, mp1map::Kernel> kernels_;
    std::uint32_t group_count_;
};

}  // namespace hemirad
