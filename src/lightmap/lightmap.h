#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hemirad {

enum class Quantity { irradiance, radiosity };

/// The atlas of all charts, row by row from the top.
struct Lightmap {
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> bands;
    std::vector<std::vector<float>> values;  ///< [band][y * width + x], W/m^2
    /// Fraction of the texel's square that the surface fills; 0 in gutters and between charts.
    std::vector<float> coverage;
    /// Further quantities, W/m^2: [name][band][y * width + x].
    std::map<std::string, std::vector<std::vector<float>>> layers = {};

    std::size_t texel_count() const { return std::size_t{width} * height; }
};

}  // namespace hemirad
