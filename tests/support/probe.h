#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "support/kernel_run.h"

/// What the tests of the kernels' mathematics have in common.
namespace hemirad::test {

using Float3 = std::array<float, 3>;

inline glm::dvec3 exact(const Float3& v) { return {v[0], v[1], v[2]}; }

inline Float3 rounded(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Points as a probe reads them: [axis][point].
inline std::vector<float> by_axis(const std::vector<Float3>& points) {
    std::vector<float> result;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const auto& point : points) result.push_back(point[axis]);
    return result;
}

/// All widths of a datapath; any number of values that sixteen divides suits them.
inline const std::vector<std::uint32_t>& all_lanes() {
    static const std::vector<std::uint32_t> lanes = {1, 4, 8, 16};
    return lanes;
}

inline KernelOptions probe_options(std::uint32_t lanes, std::uint32_t corners = 3,
                                   std::uint32_t resolution = 64) {
    KernelOptions options;
    options.lanes = lanes;
    options.corners = corners;
    options.resolution = resolution;
    return options;
}

/// Work-items for `count` values, in groups that divide any multiple of sixteen.
inline mp1map::Grid probe_grid(std::size_t count, std::uint32_t lanes) {
    return {count / lanes, 1};
}

}  // namespace hemirad::test
