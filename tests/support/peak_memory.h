#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace hemirad::test {

/// Bytes that Linux says were resident at most since the last reset.
inline std::uint64_t peak_resident() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (std::uint64_t kilobytes = 0; word == "VmHWM:" && status >> kilobytes)
            return kilobytes << 10;
    return 0;
}

/// By how much the work makes the process grow, while it lasts (proc(5), clear_refs).
template <class Work>
std::uint64_t peak_growth(Work work) {
    std::ofstream("/proc/self/clear_refs") << 5;
    const std::uint64_t before = peak_resident();
    work();
    return peak_resident() - before;
}

}  // namespace hemirad::test
