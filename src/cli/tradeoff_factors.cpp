#include "cli/tradeoff_factors.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "reference/form_factor_matrix.h"
#include "reference/item_buffer.h"
#include "reference/monte_carlo.h"
#include "reference/ray_caster.h"
#include "solver/solver.h"
#include "solver/view_factors.h"

#ifdef HEMI_EMBREE
#include "reference/embree/embree_caster.h"
#endif

namespace hemirad {
namespace {

#ifdef HEMI_EMBREE
using Caster = reference::EmbreeCaster;
#else
using Caster = reference::RayCaster;
#endif

struct FactorRow {
    std::vector<double> values;  ///< [patch]
    double samples = 0;
};

using RowMaker = std::function<FactorRow(std::uint32_t shooter)>;

std::vector<reference::Polygon> polygons_of(const Mesh& mesh) {
    std::vector<reference::Polygon> polygons;
    for (const Patch& patch : mesh.patches) {
        reference::Polygon& polygon = polygons.emplace_back();
        for (std::size_t corner = 0; corner < 4; ++corner)
            polygon.corners[corner] = mesh.vertices[patch.corners[corner]];
    }
    return polygons;
}

std::vector<std::uint32_t> spread_shooters(const Mesh& mesh, std::uint32_t count) {
    std::vector<std::uint32_t> fronts;
    for (std::uint32_t patch = 0; patch < mesh.patches.size(); ++patch)
        if (mesh.surfaces[mesh.patches[patch].surface].has_chart) fronts.push_back(patch);
    std::vector<std::uint32_t> shooters;
    const std::size_t most = std::min<std::size_t>(count, fronts.size());
    for (std::size_t i = 0; i < most; ++i)
        shooters.push_back(fronts[(2 * i + 1) * fronts.size() / (2 * most)]);
    return shooters;
}

PipelineSettings pipeline_settings(const FactorPoint& point, const Mesh& mesh) {
    PipelineSettings settings;
    settings.resolution = point.resolution;
    settings.shooter_samples = point.shooter_samples;
    settings.variants.constant_distance = point.method == Method::constant_distance;
    if (point.method == Method::analytic) {
        settings.form_factor = FormFactorMode::analytic;
        settings.near_pairs = near_pairs(mesh, SolverSettings{}.sampling_error);
    }
    return settings;
}

/// As update_radiosity.cl takes them.
std::vector<double> device_factors(ShotPipeline& pipeline, double proxels, std::size_t count) {
    std::vector<double> values;
    if (pipeline.mode() == FormFactorMode::count) {
        for (const std::int32_t owned : pipeline.proxel_counts()) values.push_back(owned / proxels);
    } else {
        const auto shot = pipeline.shot();
        const auto sums = pipeline.factors();
        for (std::size_t patch = 0; patch < count; ++patch)
            values.push_back(shot.factor_scale * sums[kVisibleFactor * pipeline.stride() + patch] +
                             shot.residual_share *
                                 sums[kDoubtfulFactor * pipeline.stride() + patch]);
    }
    values.resize(count);
    return values;
}

FactorRow device_row(ShotPipeline& pipeline, std::uint32_t shooter, std::size_t patch_count) {
    project_shooter(pipeline, shooter);
    if (pipeline.mode() == FormFactorMode::analytic) close_form_factors(pipeline);
    FactorRow row{{}, static_cast<double>(pipeline.disk_proxels() * pipeline.part_count(shooter))};
    row.values = device_factors(pipeline, row.samples, patch_count);
    return row;
}

RowMaker on_device(const FactorPoint& point, const Mesh& mesh, const mp1map::Device& device) {
    const PatchArrays arrays = patch_arrays(mesh);
    const auto pipeline = std::make_shared<ShotPipeline>(arrays, even_light(arrays),
                                                         pipeline_settings(point, mesh), device);
    pipeline->init_plane();
    return [pipeline, count = arrays.patch_count](std::uint32_t shooter) {
        return device_row(*pipeline, shooter, count);
    };
}

using Polygons = std::vector<reference::Polygon>;

reference::PointFactors from_point(const FactorPoint& point, const reference::Shooter& shooter,
                                   const Polygons& polygons) {
    const int resolution = static_cast<int>(point.resolution);
    switch (point.method) {
        case Method::hemicube:
            return reference::hemicube_factors(shooter, polygons, resolution);
        case Method::single_plane:
            return reference::single_plane_factors(shooter, polygons, resolution,
                                                   point.plane_half_width);
        case Method::constant_distance:
            return reference::hemisphere_factors(shooter, polygons, resolution,
                                                 reference::Distance::of_patch);
        default:
            return reference::hemisphere_factors(shooter, polygons, resolution);
    }
}

/// The mean over the shooting patch.
RowMaker on_host(const FactorPoint& point, const Polygons& polygons) {
    return [point, &polygons](std::uint32_t from) {
        FactorRow row{std::vector<double>(polygons.size()), 0};
        const auto shooters =
            reference::shooters_on(polygons[from], static_cast<int>(point.shooter_samples));
        const auto shares =
            reference::sample_shares(polygons[from], static_cast<int>(point.shooter_samples));
        for (std::size_t i = 0; i < shooters.size(); ++i) {
            const auto factors = from_point(point, shooters[i], polygons);
            for (std::size_t patch = 0; patch < polygons.size(); ++patch)
                row.values[patch] += shares[i] * factors.values[patch];
            row.samples += static_cast<double>(factors.sample_count);
        }
        return row;
    };
}

RowMaker by_rays(const FactorPoint& point, const Polygons& polygons) {
    const auto caster = std::make_shared<Caster>(polygons);
    const auto first_front = [caster](const glm::dvec3& origin, const glm::dvec3& direction) {
        return (*caster)(origin, direction);
    };
    return [=, &polygons](std::uint32_t from) {
        const auto factors = reference::monte_carlo_factors(polygons[from], polygons.size(),
                                                            first_front, point.rays, from);
        return FactorRow{factors.values, static_cast<double>(point.rays)};
    };
}

/// Sums of what FactorErrors holds.
class ErrorSums {
  public:
    void add(const FactorRow& row, const std::vector<double>& truth, double outside) {
        for (std::size_t patch = 0; patch < truth.size(); ++patch) {
            if (truth[patch] == 0 && row.values[patch] == 0) continue;
            const double error = row.values[patch] - truth[patch];
            squares_ += error * error;
            largest_ = std::max(largest_, std::abs(error));
            ++seen_;
        }
        const double sum = std::accumulate(row.values.begin(), row.values.end(), outside);
        row_sums_ += std::abs(sum - 1);
        ++rows_;
    }
    FactorErrors errors() const {
        return {seen_ > 0 ? std::sqrt(squares_ / seen_) : 0, largest_, row_sums_ / rows_};
    }

  private:
    double squares_ = 0, largest_ = 0, row_sums_ = 0;
    double seen_ = 0, rows_ = 0;
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

FactorRows::FactorRows(const Mesh& mesh, std::uint32_t shooters, double truth_error,
                       const mp1map::Device& device, std::function<bool()> go_on)
    : mesh_(mesh),
      device_(device),
      go_on_(std::move(go_on)),
      polygons_(polygons_of(mesh)),
      shooters_(spread_shooters(mesh, shooters)) {
    ViewFactorSettings settings;
    settings.target_error = truth_error;
    settings.from = shooters_;
    const auto factors =
        view_factors(mesh, settings, device, [&](std::size_t, std::size_t) { return go_on_(); });
    for (const auto& row : factors.rows) {
        auto& values = truth_.emplace_back(mesh.patches.size());
        for (const FormFactor& factor : row) values[factor.to] = factor.value;
    }
    outside_ = factors.outside;
}

std::optional<FactorMeasurement> FactorRows::measure(const FactorPoint& point) const {
    if (!go_on_()) return {};
    const RowMaker make_row = point.method == Method::monte_carlo ? by_rays(point, polygons_)
                              : point.runs_on == RunsOn::device   ? on_device(point, mesh_, device_)
                                                                  : on_host(point, polygons_);
    make_row(shooters_.front());  // the first call builds and warms up
    FactorMeasurement measurement;
    ErrorSums sums;
    std::vector<double> seconds;
    for (std::size_t row = 0; row < shooters_.size(); ++row) {
        if (!go_on_()) return {};
        const auto start = std::chrono::steady_clock::now();
        const FactorRow made = make_row(shooters_[row]);
        const auto passed = std::chrono::steady_clock::now() - start;
        seconds.push_back(std::chrono::duration<double>(passed).count());
        measurement.samples = made.samples;
        sums.add(made, truth_[row], outside_[row]);
    }
    measurement.seconds = median(std::move(seconds));
    measurement.errors = sums.errors();
    return measurement;
}

}  // namespace hemirad
