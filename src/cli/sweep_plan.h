#pragma once

#include <cstdint>
#include <vector>

#include "mp1map/device.h"
#include "solver/sweep_point.h"

namespace hemirad {

/// A point of the sweep, and how much of the device it gets.
struct PlannedPoint {
    SweepPoint point;
    std::uint32_t compute_units = 0;  ///< 0: all
};

/// Lines through two base points, one setting at a time: the paper's machine (32x32 PEs of one
/// lane) and the device's fast default, both at 1024 x 1024 proxels. Each point once.
std::vector<PlannedPoint> sweep_plan(const mp1map::DeviceSummary& device);

/// Few points of few proxels, of every kind.
std::vector<PlannedPoint> smoke_plan();

}  // namespace hemirad
