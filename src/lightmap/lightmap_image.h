#pragma once

#include <string>

#include "lightmap/lightmap.h"

namespace hemirad {

/// A lightmap as glTF takes it: an 8-bit PNG, linear, whose pixels / 255 * intensity are what the
/// lightmap holds; of bands that are not three those that shown_bands() names.
struct LightmapImage {
    std::string png;
    double intensity = 1;
};

LightmapImage lightmap_image(const Lightmap& lightmap);

}  // namespace hemirad
