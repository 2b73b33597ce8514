#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "lightmap/lightmap.h"
#include "solver/solution.h"

namespace hemirad {

struct Attribute {
    std::string name;  ///< stored as `hemirad.NAME`
    std::variant<std::string, double> value;
};

/// What the solution itself says: quantity, unit, shots, unshot_fraction, ledger_residual (the
/// largest of the bands), converged. The caller adds version, scene, resolution and settings.
std::vector<Attribute> describe(const Solution& solution, Quantity quantity);

enum class PixelType { float32, half };

/// InputError where bands' and layers' names cannot all be channels'.
void require_channel_names(const Lightmap& lightmap);

/// Scanline OpenEXR, ZIP: a channel a band plus `coverage`, LAYER.COMPONENT for layers, no alpha.
/// What a layer means stands in the attribute `hemirad.layer.NAME`. The same arguments give the
/// same bytes. A channel with a value beyond the range of half is one of floats. Throws
/// OutputError, and InputError as require_channel_names().
void write_exr(const std::filesystem::path& path, const Lightmap& lightmap,
               const std::vector<Attribute>& attributes, PixelType type = PixelType::float32);

}  // namespace hemirad
