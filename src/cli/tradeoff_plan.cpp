#include "cli/tradeoff_plan.h"

namespace hemirad {
namespace {

using Numbers = std::vector<std::uint32_t>;

FactorPoint projected(Method method, RunsOn runs_on, std::uint32_t resolution,
                      std::uint32_t samples) {
    FactorPoint point;
    point.method = method;
    point.runs_on = runs_on;
    point.resolution = resolution;
    point.shooter_samples = samples;
    return point;
}

void add_on_device(std::vector<FactorPoint>& points, const Numbers& resolutions,
                   const Numbers& samples) {
    for (const std::uint32_t m : samples)
        for (const std::uint32_t n : resolutions)
            for (const Method method : {Method::count, Method::analytic, Method::constant_distance})
                points.push_back(projected(method, RunsOn::device, n, m));
}

void add_on_host(std::vector<FactorPoint>& points, const Numbers& resolutions,
                 const Numbers& samples, const std::vector<double>& half_widths) {
    for (const std::uint32_t m : samples)
        for (const std::uint32_t n : resolutions) {
            for (const Method method : {Method::count, Method::hemicube})
                points.push_back(projected(method, RunsOn::host, n, m));
            for (const double half_width : half_widths) {
                points.push_back(projected(Method::single_plane, RunsOn::host, n, m));
                points.back().plane_half_width = half_width;
            }
        }
}

void add_rays(std::vector<FactorPoint>& points, std::uint64_t fewest, std::uint64_t most) {
    for (std::uint64_t rays = fewest; rays <= most; rays *= 4) {
        FactorPoint point;
        point.method = Method::monte_carlo;
        point.runs_on = RunsOn::host;
        point.rays = rays;
        points.push_back(point);
    }
}

void add_solves(std::vector<SolvePoint>& points, const std::vector<double>& patch_scales,
                const Numbers& resolutions, const Numbers& samples) {
    for (const double scale : patch_scales)
        for (const std::uint32_t n : resolutions) {
            for (const std::uint32_t m : samples)
                for (const Method method : {Method::count, Method::analytic})
                    points.push_back({method, n, m, scale});
            points.push_back({Method::constant_distance, n, 1, scale});
        }
}

}  // namespace

std::string name_of(Method method) {
    switch (method) {
        case Method::count:
            return "count";
        case Method::analytic:
            return "analytic";
        case Method::constant_distance:
            return "constant_distance";
        case Method::hemicube:
            return "hemicube";
        case Method::single_plane:
            return "single_plane";
        case Method::monte_carlo:
            return "monte_carlo";
    }
    return "";
}

std::string name_of(RunsOn machine) { return machine == RunsOn::device ? "device" : "host"; }

TradeoffPlan tradeoff_plan() {
    TradeoffPlan plan;
    plan.shooters = 32;
    plan.truth_error = 1e-6;
    add_on_device(plan.factors, {32, 64, 128, 256, 512, 1024}, {1, 2, 4, 8});
    // Planes that 8, 1.6 and 0.4 % of what leaves the shooter pass by.
    add_on_host(plan.factors, {32, 64, 128, 256, 512}, {1, 2, 4}, {3, 7, 15});
    add_rays(plan.factors, 1 << 10, 1 << 20);
    plan.finest = {Method::analytic, 512, 8, 1};
    add_solves(plan.solves, {4, 2, 1}, {32, 64, 128, 256, 512}, {1, 2, 4});
    return plan;
}

TradeoffPlan quick_tradeoff_plan() {
    TradeoffPlan plan;
    plan.shooters = 8;
    plan.truth_error = 1e-5;
    add_on_device(plan.factors, {32, 128}, {1, 2});
    add_on_host(plan.factors, {32, 128}, {1, 2}, {7});
    add_rays(plan.factors, 1 << 10, 1 << 14);
    plan.finest = {Method::analytic, 256, 4, 1};
    add_solves(plan.solves, {2, 1}, {32, 128}, {1, 2});
    return plan;
}

}  // namespace hemirad
