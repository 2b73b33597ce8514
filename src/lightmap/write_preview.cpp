#include "lightmap/write_preview.h"

#include "lightmap/atomic_file.h"
#include "lightmap/png.h"
#include "lightmap/tone.h"

namespace hemirad {
namespace {

double exposure_of(const Lightmap& lightmap, const ShownBands& shown) {
    std::vector<double> luminances;
    for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel) {
        if (lightmap.coverage[texel] == 0.0f) continue;
        const auto value = [&](std::size_t i) { return lightmap.values[shown[i]][texel]; };
        luminances.push_back(luminance(value(0), value(1), value(2)));
    }
    return exposure_for(std::move(luminances));
}

Picture picture_of(const Lightmap& lightmap) {
    const ShownBands shown = shown_bands(lightmap.bands.size());
    const double exposure = exposure_of(lightmap, shown);
    Picture picture{lightmap.width, lightmap.height, lightmap.bands.size() == 1 ? 1u : 3u, {}};
    picture.pixels.reserve(lightmap.texel_count() * picture.channel_count);
    for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel) {
        for (std::size_t channel = 0; channel < picture.channel_count; ++channel) {
            picture.pixels.push_back(film_pixel(lightmap.values[shown[channel]][texel], exposure));
        }
    }
    return picture;
}

}  // namespace

void write_preview(const std::filesystem::path& path, const Lightmap& lightmap) {
    const Picture picture = picture_of(lightmap);
    write_atomically(path, [&](std::ostream& stream) { write_png(stream, picture); });
}

}  // namespace hemirad
