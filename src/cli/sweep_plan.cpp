#include "cli/sweep_plan.h"

namespace hemirad {
namespace {

using mp1map::Broadcast;
using mp1map::Layout;

constexpr std::uint32_t kBaseResolution = 1024;
constexpr std::uint32_t kPaperSide = 32;

SweepPoint fast_default(std::uint32_t resolution) {
    SweepPoint point;
    point.resolution = resolution;
    return point;
}

// One tile is the array's own area, or 64 proxels: what a device's local memory surely holds.
// Arrays above the limit are cut in blocks; areas remain those of the whole array.
SweepPoint mp1_of(std::uint32_t side, std::uint32_t resolution, std::size_t most_work_items) {
    SweepPoint point;
    point.resolution = resolution;
    point.mp1_width = point.mp1_height = side;
    auto& array = point.pe_array;
    array.width = array.height = side;
    array.lanes = 1;
    while (std::size_t{array.width} * array.height > most_work_items)
        (array.width >= array.height ? array.width : array.height) /= 2;
    return point;
}

template <class Change>
PlannedPoint changed(SweepPoint point, Change&& change) {
    change(point);
    return {point, 0};
}

// Settings that no line but their own departs from.
void add_variants(std::vector<PlannedPoint>& plan, const SweepPoint& base) {
    plan.push_back(changed(base, [](auto& p) { p.pe_array.layout = Layout::block; }));
    plan.push_back(changed(base, [](auto& p) { p.pe_array.broadcast = Broadcast::patch; }));
    plan.push_back(changed(base, [](auto& p) { p.pe_array.broadcast = Broadcast::level; }));
    plan.push_back(changed(base, [](auto& p) { p.variants.xnet = true; }));
    plan.push_back(changed(base, [](auto& p) { p.variants.constant_distance = true; }));
}

void add_resolutions(std::vector<PlannedPoint>& plan, const SweepPoint& base) {
    for (std::uint32_t resolution = 64; resolution <= 2048; resolution *= 2) {
        const auto direct = changed(base, [&](auto& p) { p.resolution = resolution; });
        if (resolution != base.resolution) plan.push_back(direct);
        plan.push_back(changed(direct.point, [](auto& p) { p.variants.incremental = true; }));
    }
}

void add_compute_units(std::vector<PlannedPoint>& plan, const SweepPoint& base,
                       const mp1map::DeviceSummary& device) {
    if (!device.is_divisible) return;
    for (std::uint32_t fewer = 1; fewer < device.compute_units; fewer *= 2)
        plan.push_back({base, fewer});
}

}  // namespace

std::vector<PlannedPoint> sweep_plan(const mp1map::DeviceSummary& device) {
    const auto fast = fast_default(kBaseResolution);
    const auto paper = mp1_of(kPaperSide, kBaseResolution, device.max_work_group);
    std::vector<PlannedPoint> plan{{fast, 0}, {paper, 0}};
    for (const std::uint32_t side : {8u, 16u, 64u, 128u})
        plan.push_back({mp1_of(side, kBaseResolution, device.max_work_group), 0});
    for (const auto& base : {fast, paper}) {
        const auto own = mp1map::fit_pe_array(device, base.pe_array).lanes;
        for (const std::uint32_t lanes : {1u, 4u, 8u, 16u})
            if (lanes != own)
                plan.push_back(changed(base, [&](auto& p) { p.pe_array.lanes = lanes; }));
        add_variants(plan, base);
        add_resolutions(plan, base);
    }
    for (const auto& base : {fast, paper}) add_compute_units(plan, base, device);
    return plan;
}

std::vector<PlannedPoint> smoke_plan() {
    constexpr std::uint32_t kFewProxels = 64;
    constexpr std::size_t kWorkItems = 256;
    const auto fast = fast_default(kFewProxels);
    std::vector<PlannedPoint> plan{{fast, 0}};
    plan.push_back({mp1_of(8, kFewProxels, kWorkItems), 0});
    plan.push_back({mp1_of(kPaperSide, kFewProxels, kWorkItems), 0});
    plan.push_back(changed(fast, [](auto& p) { p.pe_array.layout = Layout::block; }));
    plan.push_back(changed(fast, [](auto& p) { p.variants.xnet = true; }));
    plan.push_back(changed(fast, [](auto& p) { p.variants.incremental = true; }));
    plan.push_back({fast, 1});
    return plan;
}

}  // namespace hemirad
