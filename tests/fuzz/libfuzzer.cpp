#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "fuzz/targets.h"

/// One program a target: HEMI_FUZZ_TARGET is its function.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) try {
    hemirad::fuzz::HEMI_FUZZ_TARGET({reinterpret_cast<const char*>(bytes), size});
    return 0;
} catch (const std::exception& fault) {
    std::fprintf(stderr, "not an answer: %s\n", fault.what());
    std::abort();
}
