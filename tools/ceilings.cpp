#include "ceilings.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace hemirad {
namespace {

// A work-item copies vectors that lie one after another; its multiply-adds are enough chains, none
// of which waits for itself.
constexpr const char* kSource = R"(
__kernel void copy(__global const float16* from, __global float16* to, int count) {
    const long begin = (long)count * get_group_id(0) / get_num_groups(0);
    const long end = (long)count * (get_group_id(0) + 1) / get_num_groups(0);
    for (long i = begin; i < end; ++i) to[i] = from[i];
}
__kernel void multiply_add(__global float16* sums, float16 factor, int count) {
    float16 a = 0.0f, b = 1.0f, c = 2.0f, d = 3.0f, e = 4.0f, f = 5.0f, g = 6.0f, h = 7.0f;
    float16 k = 8.0f, l = 9.0f, m = 10.0f, n = 11.0f;
    for (int i = 0; i < count; ++i) {
        a = fma(a, factor, factor), b = fma(b, factor, factor), c = fma(c, factor, factor);
        d = fma(d, factor, factor), e = fma(e, factor, factor), f = fma(f, factor, factor);
        g = fma(g, factor, factor), h = fma(h, factor, factor), k = fma(k, factor, factor);
        l = fma(l, factor, factor), m = fma(m, factor, factor), n = fma(n, factor, factor);
    }
    sums[get_group_id(0)] = a + b + c + d + e + f + g + h + k + l + m + n;
}
)";
constexpr double kChains = 12;
constexpr std::int32_t kMultiplyAdds = 1 << 18;  // a chain
constexpr int kRuns = 15;

struct Vector {
    float lane[16];
};

// The fastest of some runs; the first, which may find cold memory, is among them.
template <class Launch>
double least_seconds(mp1map::Acu& acu, const std::string& kernel, const Launch& launch) {
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < kRuns; ++run) {
        const auto before = acu.kernel_seconds();
        launch();
        const double taken = acu.kernel_seconds().at(kernel).first -
                             (before.contains(kernel) ? before.at(kernel).first : 0.0);
        least = std::min(least, taken);
    }
    return least;
}

}  // namespace

Ceilings::Ceilings(const mp1map::Device& device)
    : acu_(device, true),
      kernels_(mp1map::build_kernels(device, {"copy", "multiply_add"}, kSource, "")),
      group_count_(4 * device.summary().compute_units) {}

double Ceilings::copy_seconds(std::uint64_t bytes) {
    const auto vectors = std::max<std::uint64_t>(bytes / 2 / sizeof(Vector), 1);
    const auto from = acu_.plural<Vector>(vectors), to = acu_.plural<Vector>(vectors);
    return least_seconds(acu_, "copy", [&] {
        acu_.issue(kernels_.at("copy"), {group_count_, 1}, from, to,
                   static_cast<std::int32_t>(vectors));
    });
}

double Ceilings::flops() {
    const auto sums = acu_.plural<Vector>(group_count_);
    Vector factor;
    std::fill(std::begin(factor.lane), std::end(factor.lane), 0.5f);
    const double seconds = least_seconds(acu_, "multiply_add", [&] {
        acu_.issue(kernels_.at("multiply_add"), {group_count_, 1}, sums, factor, kMultiplyAdds);
    });
    return 2 * 16 * kChains * kMultiplyAdds * group_count_ / seconds;
}

}  // namespace hemirad
