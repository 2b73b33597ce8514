#include "lightmap/write_preview.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>

#include "lightmap/atomic_file.h"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace hemirad {
namespace {

/// The luminance that nine tenths of the covered texels stay below is shown at 80 % of white:
/// lamps, the brightest texels of most scenes, may burn out.
constexpr double kExposurePercentile = 0.9;
constexpr double kShownAt = 0.8;

/// Bands shown as red, green and blue.
using ShownBands = std::array<std::size_t, 3>;

ShownBands shown_bands(std::size_t band_count) {
    if (band_count == 3) return {0, 1, 2};
    return {band_count - 1, (band_count - 1) / 2, 0};
}

/// ITU-R BT.709, the primaries of sRGB.
double luminance(const Lightmap& lightmap, const ShownBands& shown, std::size_t texel) {
    return 0.2126 * lightmap.values[shown[0]][texel] + 0.7152 * lightmap.values[shown[1]][texel] +
           0.0722 * lightmap.values[shown[2]][texel];
}

/// The factor of a film's response 1 - exp(-exposure * value); 0 where all is dark.
double exposure_of(const Lightmap& lightmap, const ShownBands& shown) {
    std::vector<double> lit;
    for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel) {
        if (lightmap.coverage[texel] == 0.0f) continue;
        if (const double l = luminance(lightmap, shown, texel); l > 0.0) lit.push_back(l);
    }
    if (lit.empty()) return 0.0;
    const auto rank = static_cast<std::ptrdiff_t>(kExposurePercentile * double(lit.size() - 1));
    std::nth_element(lit.begin(), lit.begin() + rank, lit.end());
    return -std::log(1.0 - kShownAt) / lit[static_cast<std::size_t>(rank)];
}

/// IEC 61966-2-1.
double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

unsigned char pixel_of(double value, double exposure) {
    const double shown = 1.0 - std::exp(-exposure * std::max(value, 0.0));
    return static_cast<unsigned char>(std::lround(255.0 * srgb_from_linear(shown)));
}

std::vector<unsigned char> pixels_of(const Lightmap& lightmap, std::size_t channel_count) {
    const ShownBands shown = shown_bands(lightmap.bands.size());
    const double exposure = exposure_of(lightmap, shown);
    std::vector<unsigned char> pixels;
    pixels.reserve(lightmap.texel_count() * channel_count);
    for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel) {
        for (std::size_t channel = 0; channel < channel_count; ++channel) {
            pixels.push_back(pixel_of(lightmap.values[shown[channel]][texel], exposure));
        }
    }
    return pixels;
}

void append(void* stream, void* bytes, int count) {
    static_cast<std::ostream*>(stream)->write(static_cast<const char*>(bytes), count);
}

}  // namespace

void write_preview(const std::filesystem::path& path, const Lightmap& lightmap) {
    const int channel_count = lightmap.bands.size() == 1 ? 1 : 3;
    const auto pixels = pixels_of(lightmap, static_cast<std::size_t>(channel_count));
    const int width = static_cast<int>(lightmap.width), height = static_cast<int>(lightmap.height);
    write_atomically(path, [&](std::ostream& stream) {
        const int done = stbi_write_png_to_func(append, &stream, width, height, channel_count,
                                                pixels.data(), width * channel_count);
        if (done == 0) throw std::bad_alloc();
    });
}

}  // namespace hemirad
