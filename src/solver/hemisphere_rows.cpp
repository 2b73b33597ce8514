#include "solver/hemisphere_rows.h"

#include "solver/solver.h"

namespace hemirad {

HemisphereRows::HemisphereRows(const Mesh& mesh, const PipelineSettings& settings,
                               const mp1map::Device& device)
    : patch_count_(static_cast<std::uint32_t>(mesh.patches.size())), pipeline_([&] {
          const PatchArrays arrays = patch_arrays(mesh);
          return ShotPipeline(arrays, even_light(arrays), settings, device);
      }()) {
    pipeline_.init_plane();
}

ProxelRow HemisphereRows::row(std::uint32_t patch) {
    const std::uint32_t parts = pipeline_.part_count(patch);
    for (;;) {
        pipeline_.clear_counts();
        pipeline_.set_shooter(patch);
        for (std::uint32_t part = 0; part < parts; ++part) project_hemisphere(pipeline_);
        if (pipeline_.shot().status != kBinsFull) break;
        pipeline_.enlarge_lists();
    }
    ProxelRow row;
    row.owned = pipeline_.proxel_counts();
    row.escaped = row.owned[pipeline_.stride()];
    row.owned.resize(patch_count_);
    row.part_count = parts;
    row.all = pipeline_.disk_proxels() * parts;
    return row;
}

}  // namespace hemirad
