#include "solver/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "solver/solver.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

// Points between two looks at the device take about this long.
constexpr double kSecondsBetweenLooks = 0.2;
constexpr std::size_t kMostBatch = 1u << 14;

double largest(const std::vector<double>& values) {
    return values.empty() ? 0 : *std::ranges::max_element(values);
}

// Of a band, so that floats hold what doubles do.
double unit_of(const std::vector<double>& radiosity) {
    const double most = largest(radiosity);
    return most > 0 ? most : 1;
}

// Of small meshes, too: bits do not depend on it.
std::uint32_t points_at_once(const Mesh& mesh, const GatherSettings& settings) {
    constexpr auto kMany = std::numeric_limits<std::uint64_t>::max();
    return usable_salvo(0, kMany, mesh.patches.size(), settings.resolution);
}

PipelineSettings pipeline_settings(const GatherSettings& settings, std::uint32_t salvo) {
    PipelineSettings result;
    result.resolution = settings.resolution;
    result.form_factor = settings.form_factor;
    result.salvo = salvo;
    result.pe_array = settings.pe_array;
    result.variants = settings.variants;
    result.kernels_dir = settings.kernels_dir;
    result.gathers = true;
    return result;
}

// As aim_hemisphere.cl turns the disks of shooters: by 15 to 75 degrees.
double angle_of(std::uint32_t turn) {
    return (1.0 / 12 + turn * (1.0 / 3 / 4294967296.0)) * std::numbers::pi;
}

template <class Values>
void store(const glm::dvec3& from, Values& to) {
    for (int axis = 0; axis < 3; ++axis)
        to[axis] = static_cast<std::remove_reference_t<decltype(to[0])>>(from[axis]);
}

void gather_salvo(ShotPipeline& pipeline, std::uint32_t first, std::uint32_t end) {
    pipeline.aim_points(first, end);
    project_aimed(pipeline);
    if (pipeline.mode() == FormFactorMode::analytic) {
        pipeline.add_up_factors();
        pipeline.spread_residual();
    }
    pipeline.gather_irradiance();
    pipeline.add_up_irradiance();
}

}  // namespace

Gather::Gather(const Mesh& mesh, const std::vector<std::vector<double>>& radiosity,
               const GatherSettings& settings, const mp1map::Device& device)
    : mesh_(mesh),
      arrays_(patch_arrays(mesh, settings.form_factor == FormFactorMode::analytic)),
      salvo_(points_at_once(mesh, settings)),
      pipeline_(arrays_, even_light(arrays_), pipeline_settings(settings, salvo_), device),
      batch_(salvo_) {
    std::vector<float> on_device(radiosity.size() * arrays_.stride);
    for (std::size_t band = 0; band < radiosity.size(); ++band) {
        unit_.push_back(unit_of(radiosity[band]));
        for (std::size_t i = 0; i < radiosity[band].size(); ++i)
            on_device[band * arrays_.stride + i] =
                static_cast<float>(radiosity[band][i] / unit_.back());
    }
    pipeline_.init_plane();
    pipeline_.load_radiosity(on_device);
}

device::GatherPoint Gather::aimed(const SurfacePoint& point) const {
    const Patch& patch = mesh_.patches[point.patch];
    const Surface& surface = mesh_.surfaces[patch.surface];
    const glm::dvec3 normal = mesh_.normal(patch);
    const glm::dvec3 along =
        glm::normalize(surface.u_axis - normal * glm::dot(normal, surface.u_axis));
    const double angle = angle_of(point.turn);
    const glm::dvec3 u_axis = std::cos(angle) * along + std::sin(angle) * glm::cross(normal, along);
    const glm::dvec3 steps =
        (point.position - arrays_.centre) * (arrays_.scale / double{kGridStep});
    device::GatherPoint aimed{};
    aimed.plane = static_cast<std::int32_t>(surface.plane);
    aimed.reached = arrays_.reached[point.patch];
    store(glm::round(steps), aimed.origin);
    store(u_axis, aimed.u_axis);
    store(glm::cross(normal, u_axis), aimed.v_axis);
    store(normal, aimed.normal);
    return aimed;
}

std::vector<float> Gather::look_from(std::span<const SurfacePoint> points) {
    std::vector<device::GatherPoint> aims;
    for (const SurfacePoint& point : points) aims.push_back(aimed(point));
    pipeline_.load_points(aims);
    const auto end = static_cast<std::uint32_t>(points.size());
    for (;;) {
        for (std::uint32_t first = 0; first < end; first += salvo_)
            gather_salvo(pipeline_, first, end);
        if (pipeline_.shot().status != kBinsFull) return pipeline_.gathered();
        pipeline_.enlarge_lists();
    }
}

std::optional<std::vector<std::vector<double>>> Gather::irradiance(
    std::span<const SurfacePoint> points, const PointProgress& on_progress) {
    std::vector<std::vector<double>> result(unit_.size(), std::vector<double>(points.size()));
    for (std::size_t first = 0; first < points.size();) {
        const Stopwatch stopwatch;
        const std::size_t count = std::min(batch_, points.size() - first);
        const auto gathered = look_from(points.subspan(first, count));
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t band = 0; band < unit_.size(); ++band)
                result[band][first + i] = unit_[band] * double{gathered[i * unit_.size() + band]};
        first += count;
        if (!on_progress(first)) return std::nullopt;
        const double seconds = std::max(stopwatch.seconds(), 1e-9);
        const auto next =
            static_cast<std::size_t>(static_cast<double>(count) * kSecondsBetweenLooks / seconds);
        if (count == batch_)
            batch_ = std::clamp(next, std::size_t{salvo_}, std::min(2 * batch_, kMostBatch));
    }
    return result;
}

std::uint64_t gather_bytes(const Mesh& mesh, std::size_t bands, const GatherSettings& settings,
                           const mp1map::DeviceSummary& device) {
    const auto patches = static_cast<std::uint32_t>(mesh.patches.size());
    return estimated_device_bytes(patches, patches, corner_count_of(mesh), 1, settings.resolution,
                                  settings.form_factor, 0,
                                  mp1map::fit_pe_array(device, settings.pe_array),
                                  points_at_once(mesh, settings)) +
           4 * bands * patches;
}

}  // namespace hemirad
