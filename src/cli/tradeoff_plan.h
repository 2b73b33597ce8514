#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hemirad {

enum class Method { count, analytic, constant_distance, hemicube, single_plane, monte_carlo };
enum class RunsOn { device, host };  ///< OpenCL, or one thread in double precision

std::string name_of(Method method);
std::string name_of(RunsOn machine);

/// Form factors from one patch at a time.
struct FactorPoint {
    Method method = Method::count;
    RunsOn runs_on = RunsOn::device;
    std::uint32_t resolution = 0;       ///< of the plane, or of the hemicube's top
    std::uint32_t shooter_samples = 0;  ///< M x M points a patch
    std::uint64_t rays = 0;             ///< Monte Carlo's, instead of the two
    double plane_half_width = 0;        ///< the single plane's, at distance 1
};

/// A scene's irradiance.
struct SolvePoint {
    Method method = Method::count;  ///< one that the device has
    std::uint32_t resolution = 0, shooter_samples = 0;
    double patch_scale = 1;  ///< patch size over the finest one
};

struct TradeoffPlan {
    std::uint32_t shooters = 0;  ///< rows of factors, spread over the patches
    double truth_error = 0;      ///< wanted of the factors they are compared with
    std::vector<FactorPoint> factors;
    SolvePoint finest;  ///< what solves of the same mesh are compared with
    std::vector<SolvePoint> solves;
};

TradeoffPlan tradeoff_plan();

/// Of every kind, few proxels.
TradeoffPlan quick_tradeoff_plan();

}  // namespace hemirad
