#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lightmap/chart_layout.h"
#include "scene/mesh.h"
#include "scene/surface_point.h"

namespace hemirad {

/// Texels of an atlas that show light of their own.
struct TexelProgress {
    std::size_t known = 0, all = 0;
};

/// [band][point], W/m^2; nothing: the gather is to stop.
using IrradianceAt = std::function<std::optional<std::vector<std::vector<double>>>(
    std::span<const SurfacePoint> points, const TexelProgress& before)>;

/// Light of an atlas, gathered.
struct GatheredLight {
    std::vector<std::vector<float>> irradiance;  ///< [band][texel], W/m^2
    std::vector<std::uint32_t> patch;  ///< [texel] whose light it is; kNoPatch: none was gathered
    std::size_t gathered = 0, interpolated = 0;  ///< texels
};

/// Irradiance of the texels' own points, of as many bands as `by_patch` [band][patch] has, which is
/// what the solve says of it. Up to an error of so much of the light about it, or of a tenth of the
/// band's mean where there is less, it is interpolated; 0: nowhere.
std::optional<GatheredLight> gather_light(const Mesh& mesh, const ChartLayout& layout,
                                          std::uint32_t atlas,
                                          const std::vector<std::vector<double>>& by_patch,
                                          double error, const IrradianceAt& irradiance_at);

}  // namespace hemirad
