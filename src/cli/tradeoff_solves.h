#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "cli/tradeoff_plan.h"
#include "mp1map/device.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "solver/solution.h"
#include "solver/solver.h"

namespace hemirad {

/// Irradiance against a finer solve's, area-weighted, relative to its mean; rms over the bands.
struct SolveErrors {
    double patches_rms = 0;  ///< against the finest settings on the same mesh
    double patches_largest = 0;
    double faces_rms = 0;  ///< means of input polygons, against the finest settings and mesh
};

struct SolveMeasurement {
    std::uint64_t shots = 0;
    double samples = 0;  ///< proxels of all shots
    double seconds = 0;  ///< of the solve alone: neither meshing nor building kernels
    SolveErrors errors;
};

/// False stops.
using SolveProgress = std::function<bool(const Progress&)>;

/// A scene solved with one setting after another. Solves of a mesh with the finest settings are
/// made when they are first needed.
class Solves {
  public:
    Solves(const Scene& scene, const MeshSettings& finest_mesh, const SolvePoint& finest,
           const mp1map::Device& device, SolveProgress on_progress);

    SolveMeasurement measure(const SolvePoint& point);
    std::size_t patch_count(double patch_scale) { return level(patch_scale).mesh.patches.size(); }

  private:
    struct Level {
        double patch_scale;
        Mesh mesh;
        Solution finest;
    };
    struct Solved {
        Solution solution;
        double seconds;
        double samples_a_shot;
    };

    Level& level(double patch_scale);
    Solved solve(const Mesh& mesh, const SolvePoint& point);

    const Scene& scene_;
    MeshSettings finest_mesh_;
    SolvePoint finest_;
    const mp1map::Device& device_;
    SolveProgress on_progress_;
    std::deque<Level> levels_;  ///< references outlive further ones
};

}  // namespace hemirad
