#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/options.h"
#include "scene/mesh.h"
#include "solver/accuracy.h"
#include "solver/view_factors.h"

namespace hemirad {

enum class FactorFormat { csv, view3d, view3d_sparse };

struct FormFactorsOptions {
    std::filesystem::path scene;
    std::optional<std::filesystem::path> output, report;  ///< no output: standard output
    FactorFormat format = FactorFormat::csv;
    std::vector<std::string> from, receivers_only, blockers_only;
    bool per_patch = false, enforce = false;
    MeshSettings mesh{.patch_size = std::numeric_limits<double>::infinity()};
    ViewFactorSettings factors;
    Quality quality = Quality::medium;  ///< unless factors.target_error is given
    std::string device;                 ///< as mp1map::Device::open takes it
    std::uint32_t compute_units = 0;
    bool quiet = false, no_progress = false;
};

void add_formfactors_options(CLI::App& command, FormFactorsOptions& options);

/// Before the work begins: InputError for options that exclude each other and for outputs that
/// would overwrite something else, OutputError for outputs that cannot be written.
void check_formfactors_options(const FormFactorsOptions& options);

/// Every file that the options ask for.
std::vector<std::filesystem::path> output_files(const FormFactorsOptions& options);

/// The options that decide on the numbers, as name and value, defaults resolved.
std::vector<std::pair<std::string, std::string>> deciding_options(
    const FormFactorsOptions& options);

}  // namespace hemirad
