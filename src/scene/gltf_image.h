#pragma once

#include <array>
#include <map>

#include "scene/gltf_file.h"

namespace hemirad {

using Rgb = std::array<double, 3>;

/// Of the images so far, in linear light.
struct ImageAverages {
    /// Where the bytes are: the same in many images or bufferViews are decoded once.
    using Place = std::array<std::size_t, 3>;

    const GltfFile& gltf;
    std::map<Place, Rgb> known = {};
};

/// Throws InputError where the materials show what is no image or more pixels than are read.
void check_images(const GltfFile& gltf, const Json& materials);

/// Of an image that is checked.
Rgb image_average(ImageAverages& images, std::size_t index);

}  // namespace hemirad
