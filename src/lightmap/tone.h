#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace hemirad {

/// Bands shown as red, green and blue.
using ShownBands = std::array<std::size_t, 3>;

/// Of one band that, of three these; of two or more than three the last, the middle and the first
/// (the longest to the shortest wavelength, where bands are listed by wavelength).
ShownBands shown_bands(std::size_t band_count);

/// ITU-R BT.709, the primaries of sRGB.
double luminance(double red, double green, double blue);

/// The factor of a film's response 1 - exp(-exposure * value) under which nine tenths of the
/// luminances above 0 stay below 80 % of white: lamps may burn out. 0 where there are none.
double exposure_for(std::vector<double> luminances);

/// A film's response, as sRGB.
unsigned char film_pixel(double value, double exposure);

}  // namespace hemirad
