#pragma once

#include <cstdint>
#include <vector>

namespace hemirad {

/// What a solve has come to between two shots: all that decides how it goes on, and what it ends
/// with. Who shoots next follows from what is unshot; what a shooter sees is found again, to the
/// same bits, so neither rows of form factors nor hemispheres in the making are part of it.
struct SolveState {
    std::uint64_t shots = 0, repeated_shots = 0;
    /// As device::Shot has them.
    std::int32_t least_surplus = 0, most_surplus = 0;
    std::vector<float> unshot;                   ///< [band][shooter], padded as the device does
    std::vector<float> received, received_rest;  ///< [band][patch], the same
    std::vector<float> escaped;                  ///< [band], then what their rounding lost
    std::vector<std::uint32_t> shots_of = {};    ///< [shooter], the same; empty unless counted
};

}  // namespace hemirad
