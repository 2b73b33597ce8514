#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "scene/mesh.h"
#include "scene/surface_point.h"
#include "solver/shot_pipeline.h"

namespace hemirad {

struct GatherSettings {
    std::uint32_t resolution = 256;  ///< N x N proxels on the square around the disk, 16 to 8192
    FormFactorMode form_factor = FormFactorMode::analytic;
    mp1map::PeArrayRequest pe_array = {};
    Variants variants = {};
    std::optional<std::filesystem::path> kernels_dir = {};
};

/// Final gather: the irradiance of points, E = sum over patches of F B, each point looking through
/// a hemisphere of its own with the kernels of a shot, several points at once. What escapes brings
/// nothing.
class Gather {
  public:
    /// `radiosity`: [band][patch], W/m^2, of any number of bands.
    Gather(const Mesh& mesh, const std::vector<std::vector<double>>& radiosity,
           const GatherSettings& settings, const mp1map::Device& device);

    /// Points done since the call, of all; false stops.
    using PointProgress = std::function<bool(std::size_t done)>;

    /// [band][point], W/m^2; nothing where `on_progress` has stopped it. The bits are the same
    /// whatever points are asked for together.
    std::optional<std::vector<std::vector<double>>> irradiance(std::span<const SurfacePoint> points,
                                                               const PointProgress& on_progress);

    double build_seconds() const { return pipeline_.build_seconds(); }

  private:
    device::GatherPoint aimed(const SurfacePoint& point) const;
    std::vector<float> look_from(std::span<const SurfacePoint> points);

    const Mesh& mesh_;
    PatchArrays arrays_;
    std::vector<double> unit_;  ///< [band] of the device's radiosities, W/m^2
    std::uint32_t salvo_;
    ShotPipeline pipeline_;
    std::size_t batch_;  ///< points between two looks at the device
};

/// Bytes that it holds on the device.
std::uint64_t gather_bytes(const Mesh& mesh, std::size_t bands, const GatherSettings& settings,
                           const mp1map::DeviceSummary& device);

}  // namespace hemirad
