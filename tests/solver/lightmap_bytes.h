#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>

#include "lightmap/rasterize.h"
#include "lightmap/write_exr.h"
#include "solver/support.h"

/// Lightmaps as files, and machines that must all write the same.
namespace hemirad::test {

struct Machine {
    std::string name;
    mp1map::PeArrayRequest pe_array;
    std::uint32_t compute_units = 0;
};

/// A GPU has no part of fewer units, and less local memory than some tiles need.
inline bool has(const mp1map::DeviceSummary& device, const Machine& machine) {
    return (machine.compute_units == 0 || device.is_divisible) && takes(device, machine.pe_array);
}

inline std::string exr_of(const Mesh& mesh, SolverSettings how, const Machine& machine) {
    how.pe_array = machine.pe_array;
    const auto device = mp1map::Device::open("", machine.compute_units);
    ProgressiveSolver solver(mesh, how, device);
    solver.solve(go_on);
    const Solution solution = solver.solution();
    const auto path = std::filesystem::path(testing::TempDir()) /
                      ("hemirad-same-bits-" + std::to_string(getpid()) + ".exr");
    write_exr(path, rasterize(mesh, solution, lay_out_charts(mesh), Quantity::irradiance),
              describe(solution, Quantity::irradiance));
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    std::filesystem::remove(path);
    return bytes;
}

inline void expect_same_bytes(const Mesh& mesh, const SolverSettings& how,
                              const std::vector<Machine>& machines) {
    std::string first;
    const auto device = mp1map::Device::open("").summary();
    for (const auto& machine : machines) {
        if (!has(device, machine)) continue;
        const auto bytes = exr_of(mesh, how, machine);
        ASSERT_FALSE(bytes.empty());
        if (first.empty()) first = bytes;
        EXPECT_TRUE(bytes == first) << machine.name;
    }
}

}  // namespace hemirad::test
