#include "lightmap/gather_light.h"

#include <algorithm>
#include <utility>

#include "lightmap/find_hidden.h"
#include "lightmap/gather_cells.h"
#include "lightmap/rasterize.h"

namespace hemirad {
namespace {

/// Of a band's mean: what is darker does not need more accuracy than this.
constexpr double kLeastShare = 0.1;

/// Charts are gathered together, so that a device has work, until they have so many texels.
constexpr std::size_t kTexelsTogether = 1u << 22;

double mean_of(const Mesh& mesh, const std::vector<double>& irradiance) {
    double flux = 0, area = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        if (!mesh.surfaces[mesh.patches[i].surface].has_chart) continue;
        const double own = mesh.area(mesh.patches[i]);
        flux += own * irradiance[i];
        area += own;
    }
    return area > 0 ? flux / area : 0;
}

Lightmap guide_of(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
                  const std::vector<std::vector<double>>& by_patch) {
    Solution solution;
    solution.irradiance = by_patch;
    solution.bands.resize(by_patch.size());
    return rasterize(mesh, solution, layout, Quantity::irradiance, atlas);
}

class LightGatherer {
  public:
    LightGatherer(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
                  const std::vector<std::vector<double>>& by_patch, double error,
                  const IrradianceAt& irradiance_at)
        : mesh_(mesh),
          layout_(layout),
          atlas_(atlas),
          hidden_(find_hidden(mesh)),
          blend_(mesh, hidden_, LightBlend::Across::all_materials),
          guide_(guide_of(mesh, layout, atlas, by_patch)),
          irradiance_at_(irradiance_at) {
        tolerance_.error = error;
        for (const auto& band : by_patch)
            tolerance_.least.push_back(kLeastShare * mean_of(mesh, band));
        light_.irradiance.assign(by_patch.size(), std::vector<float>(guide_.texel_count()));
        light_.patch.assign(guide_.texel_count(), kNoPatch);
        all_ = static_cast<std::size_t>(
            std::ranges::count_if(guide_.coverage, [](float part) { return part > 0; }));
    }

    std::optional<GatheredLight> run() {
        bool goes_on = true;
        for_each_footprints(mesh_, layout_, atlas_, hidden_, [&](const Footprints& footprints) {
            goes_on = goes_on && add(footprints);
        });
        if (!goes_on || !finish()) return std::nullopt;
        return std::move(light_);
    }

  private:
    bool add(Footprints footprints) {
        texels_ += footprints.texels.size();
        charts_.emplace_back(mesh_, blend_, guide_, tolerance_, std::move(footprints));
        return texels_ < kTexelsTogether || finish();
    }

    bool finish() {
        while (gather_once()) {
        }
        for (const GatherCells& chart : charts_) {
            chart.write(light_.irradiance, light_.patch);
            light_.gathered += chart.gathered_count();
            light_.interpolated += chart.interpolated_count();
        }
        charts_.clear();
        texels_ = 0;
        return !is_stopped_;
    }

    /// Whether there may be more to do.
    bool gather_once() {
        std::vector<SurfacePoint> points;
        std::vector<std::size_t> first;
        TexelProgress before{light_.gathered + light_.interpolated, all_};
        for (GatherCells& chart : charts_) {
            before.known += chart.gathered_count() + chart.interpolated_count();
            first.push_back(points.size());
            const auto wanted = chart.wanted();
            points.insert(points.end(), wanted.begin(), wanted.end());
        }
        const auto found = points.empty() ? std::make_optional(std::vector<std::vector<double>>())
                                          : irradiance_at_(points, before);
        is_stopped_ = !found;
        if (is_stopped_) return false;
        bool goes_on = false;
        for (std::size_t i = 0; i < charts_.size(); ++i)
            goes_on |= charts_[i].take(*found, first[i]);
        return goes_on;
    }

    const Mesh& mesh_;
    const ChartLayout& layout_;
    std::uint32_t atlas_;
    std::vector<bool> hidden_;
    LightBlend blend_;
    Lightmap guide_;
    const IrradianceAt& irradiance_at_;
    GatherTolerance tolerance_;
    GatheredLight light_;
    std::vector<GatherCells> charts_;
    std::size_t texels_ = 0, all_ = 0;
    bool is_stopped_ = false;
};

}  // namespace

std::optional<GatheredLight> gather_light(const Mesh& mesh, const ChartLayout& layout,
                                          std::uint32_t atlas,
                                          const std::vector<std::vector<double>>& by_patch,
                                          double error, const IrradianceAt& irradiance_at) {
    return LightGatherer(mesh, layout, atlas, by_patch, error, irradiance_at).run();
}

}  // namespace hemirad
