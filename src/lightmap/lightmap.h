#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hemirad {

enum class Quantity { irradiance, radiosity };

/// Further values of the texels.
struct Layer {
    std::vector<std::string> components;     ///< one a channel; empty: the lightmap's bands
    std::vector<std::vector<float>> values;  ///< [component][y * width + x]
    std::string meaning;                     ///< with its unit; for the header
    bool exact = false;                      ///< 11 bits, as of half, are too few
};

/// The atlas of all charts, row by row from the top.
struct Lightmap {
    std::uint32_t width = 0, height = 0;
    std::vector<std::string> bands;
    std::vector<std::vector<float>> values;  ///< [band][y * width + x], W/m^2
    /// Fraction of the texel's square that the surface fills; 0 in gutters and between charts.
    std::vector<float> coverage;
    std::map<std::string, Layer> layers = {};  ///< by name

    std::size_t texel_count() const { return std::size_t{width} * height; }
};

}  // namespace hemirad
