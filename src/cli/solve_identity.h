#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cli/solve_options.h"
#include "mp1map/device.h"
#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// What a solve's bits depend on, but for the limits that end it: two solves that are alike in all
/// of it come by the same states.
struct SolveIdentity {
    std::string version;  ///< of hemirad
    std::string scene;  ///< SHA-256 of what the scene's files say of geometry, materials and names
    std::string mesh;   ///< of what came of it
    std::string kernels;  ///< of their source
    std::string device;   ///< another one's may round otherwise
    /// Options and their values, defaults resolved. What the picture is made of the solution by is
    /// not among them, nor is the machine that changes no bit.
    std::vector<std::pair<std::string, std::string>> settings;
};

SolveIdentity identity_of(const SolveOptions& options, const Scene& scene, const Mesh& mesh,
                          const mp1map::DeviceSummary& device);

}  // namespace hemirad
