#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "formfactor/form_factors.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "scene/mesh.h"

namespace hemirad {

struct ViewFactorSettings {
    std::uint32_t resolution = 512;     ///< N x N proxels on the square around the disk
    std::uint32_t shooter_samples = 0;  ///< M x M hemispheres a patch; 0: as near patches ask for
    /// Absolute, of each factor: pairs whose error may be larger are integrated exactly.
    std::optional<double> target_error;
    mp1map::PeArrayRequest pe_array = {};
    std::optional<std::filesystem::path> kernels_dir = {};
    std::vector<std::uint32_t> from;  ///< patches; empty: all
};

/// Called with rows done and all; false stops.
using RowProgress = std::function<bool(std::size_t done, std::size_t all)>;

/// View factors of a mesh, light or no light: a row of hemispheres a patch (sec. 1.5), and for
/// pairs too near or too much in need of accuracy the closed forms past their blockers.
FormFactors view_factors(const Mesh& mesh, const ViewFactorSettings& settings,
                         const mp1map::Device& device, const RowProgress& on_progress);

}  // namespace hemirad
