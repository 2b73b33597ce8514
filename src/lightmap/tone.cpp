#include "lightmap/tone.h"

#include <algorithm>
#include <cmath>

namespace hemirad {
namespace {

/// The luminance that nine tenths of the lit texels stay below is shown at 80 % of white:
/// lamps, the brightest texels of most scenes, may burn out.
constexpr double kExposurePercentile = 0.9;
constexpr double kShownAt = 0.8;

/// IEC 61966-2-1.
double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

}  // namespace

ShownBands shown_bands(std::size_t band_count) {
    if (band_count == 3) return {0, 1, 2};
    return {band_count - 1, (band_count - 1) / 2, 0};
}

double luminance(double red, double green, double blue) {
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

double exposure_for(std::vector<double> luminances) {
    std::erase_if(luminances, [](double l) { return !(l > 0.0); });
    if (luminances.empty()) return 0.0;
    const auto rank =
        static_cast<std::ptrdiff_t>(kExposurePercentile * double(luminances.size() - 1));
    std::nth_element(luminances.begin(), luminances.begin() + rank, luminances.end());
    return -std::log(1.0 - kShownAt) / luminances[static_cast<std::size_t>(rank)];
}

unsigned char film_pixel(double value, double exposure) {
    const double shown = 1.0 - std::exp(-exposure * std::max(value, 0.0));
    return static_cast<unsigned char>(std::lround(255.0 * srgb_from_linear(shown)));
}

}  // namespace hemirad
