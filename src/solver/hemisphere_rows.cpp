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
    project_shooter(pipeline_, patch);
    ProxelRow row;
    row.owned = pipeline_.proxel_counts();
    row.escaped = row.owned[pipeline_.stride()];
    row.owned.resize(patch_count_);
    row.part_count = pipeline_.part_count(patch);
    row.all = pipeline_.disk_proxels() * row.part_count;
    return row;
}

}  // namespace hemirad
