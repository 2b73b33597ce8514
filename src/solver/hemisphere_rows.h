#pragma once

#include <cstdint>
#include <vector>

#include "solver/shot_pipeline.h"

namespace hemirad {

/// Proxels that a patch's hemispheres see of every patch, and that escape; they add up to `all`.
struct ProxelRow {
    std::vector<std::int32_t> owned;
    std::int32_t escaped = 0;
    std::uint64_t all = 0;
    std::uint32_t part_count = 1;
};

/// Rows of proxels by the kernels of a shot, light or no light.
class HemisphereRows {
  public:
    HemisphereRows(const Mesh& mesh, const PipelineSettings& settings,
                   const mp1map::Device& device);

    ProxelRow row(std::uint32_t patch);

  private:
    std::uint32_t patch_count_;
    ShotPipeline pipeline_;
};

}  // namespace hemirad
