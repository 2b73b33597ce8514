#include "lightmap/lightmap_image.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lightmap/png.h"
#include "lightmap/tone.h"

namespace hemirad {
namespace {

/// The brightest texel's, so that a step is no larger than it must be.
double intensity_of(const Lightmap& lightmap) {
    float largest = 0;
    for (const auto& band : lightmap.values)
        for (const float value : band) largest = std::max(largest, value);
    return largest > 0 ? double{largest} : 1.0;
}

std::string png_of(const Lightmap& lightmap, double intensity) {
    const ShownBands shown = shown_bands(lightmap.bands.size());
    Picture picture{lightmap.width, lightmap.height, lightmap.bands.size() == 1 ? 1u : 3u, {}};
    picture.pixels.reserve(lightmap.texel_count() * picture.channel_count);
    for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel)
        for (std::size_t channel = 0; channel < picture.channel_count; ++channel) {
            const double part = double{lightmap.values[shown[channel]][texel]} / intensity;
            picture.pixels.push_back(
                static_cast<unsigned char>(std::lround(255 * std::clamp(part, 0.0, 1.0))));
        }
    std::ostringstream stream;
    write_png(stream, picture);
    return stream.str();
}

}  // namespace

LightmapImage lightmap_image(const Lightmap& lightmap) {
    const double intensity = intensity_of(lightmap);
    return {png_of(lightmap, intensity), intensity};
}

}  // namespace hemirad
