#include "scene/gltf_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include <stb/stb_image.h>

#include "scene/short_text.h"

namespace hemirad {
namespace {

/// Half of 16384 x 16384. A few kilobytes of PNG may announce a thousand times that.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 27;

/// Of an image of four channels; while it is decoded it is held twice.
constexpr std::uint64_t kMostPixelBytes = std::uint64_t{1} << 29;

/// Of all images together, so that many small ones that each announce the most take no minutes:
/// 64 of 4096 x 4096, and what ordinary compression makes of the bytes that there are.
constexpr std::uint64_t kMostPixelsInAll = std::uint64_t{1} << 30, kPixelsOfAByte = 64;

struct EncodedImage {
    const unsigned char* bytes;
    int size;
};

// IEC 61966-2-1
double linear_from_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

/// As stb_image decoded it.
struct Pixels {
    std::size_t count = 0, channels = 0;
    std::unique_ptr<void, FreePixels> of_8_bits = {}, of_16_bits = {};  ///< one of them
};

/// How often each sample value occurs, per channel: the average then decodes each value that there
/// is once.
template <class Sample>
Rgb average(const Pixels& pixels, const void* first) {
    constexpr std::size_t kValues = std::size_t{std::numeric_limits<Sample>::max()} + 1;
    const auto* const samples = static_cast<const Sample*>(first);
    const bool is_grey = pixels.channels < 3;
    Rgb mean{};
    for (std::size_t channel = 0; channel < mean.size(); ++channel) {
        if (is_grey && channel > 0) {
            mean[channel] = mean[0];
            continue;
        }
        std::vector<std::uint64_t> counts(kValues);
        for (std::size_t pixel = 0; pixel < pixels.count; ++pixel)
            ++counts[samples[pixel * pixels.channels + channel]];
        for (std::size_t value = 0; value < kValues; ++value) {
            if (counts[value] == 0) continue;
            mean[channel] +=
                double(counts[value]) * linear_from_srgb(double(value) / double(kValues - 1));
        }
        mean[channel] /= double(pixels.count);
    }
    return mean;
}

/// glTF 2.0, sec. 3.8.2: stb_image would decode others, too.
bool is_png_or_jpeg(const EncodedImage& image) {
    const std::string_view bytes(reinterpret_cast<const char*>(image.bytes),
                                 static_cast<std::size_t>(image.size));
    return bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8\xff");
}

bool is_deep(const EncodedImage& image) {
    return stbi_is_16_bit_from_memory(image.bytes, image.size) != 0;
}

EncodedImage encoded(const GltfFile& gltf, std::size_t index) {
    const auto& image = gltf.model.images[index];
    if (image.bufferView < 0) return {image.image.data(), static_cast<int>(image.image.size())};
    const std::string_view view = view_bytes(gltf.model, image.bufferView);
    return {reinterpret_cast<const unsigned char*>(view.data()), static_cast<int>(view.size())};
}

/// Before memory is asked for. Returns how many there are.
std::uint64_t check_pixels(const InputFile& file, const std::string& path,
                           const EncodedImage& image) {
    int width = 0, height = 0, channels = 0;
    if (image.size == 0) fail(file, path, "cannot be read");
    if (!is_png_or_jpeg(image) ||
        stbi_info_from_memory(image.bytes, image.size, &width, &height, &channels) == 0)
        fail(file, path, "is neither PNG nor JPEG, or is damaged");
    const auto count = std::uint64_t(width) * std::uint64_t(height);
    const std::uint64_t most = std::min(kMostPixels, kMostPixelBytes / (is_deep(image) ? 8 : 4));
    if (count <= most) return count;
    fail(file, path,
         "is " + size_text(std::uint64_t(width), std::uint64_t(height)) +
             " pixels, more than the " + std::to_string(most) + " that are read");
}

ImageAverages::Place place_of(const GltfFile& gltf, std::size_t image) {
    const int index = gltf.model.images[image].bufferView;
    if (index < 0) return {image, 0, 0};  // no view is of 0 bytes
    const auto& view = gltf.model.bufferViews[static_cast<std::size_t>(index)];
    return {static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength};
}

/// The images that the material shows.
std::vector<std::size_t> images_of(const GltfFile& gltf, const Json& material) {
    std::vector<std::size_t> images;
    for (const char* at :
         {"/pbrMetallicRoughness/baseColorTexture/index", "/emissiveTexture/index"}) {
        const Json::json_pointer index(at), source("/source");
        if (!material.contains(index)) continue;
        const Json& texture = gltf.json["textures"][material[index].get<std::size_t>()];
        if (texture.contains(source)) images.push_back(texture[source].get<std::size_t>());
    }
    return images;
}

/// Of an image that is checked.
Pixels decoded(const GltfFile& gltf, std::size_t index) {
    const EncodedImage image = encoded(gltf, index);
    int width = 0, height = 0, channels = 0;
    Pixels pixels;
    if (is_deep(image))
        pixels.of_16_bits.reset(
            stbi_load_16_from_memory(image.bytes, image.size, &width, &height, &channels, 0));
    else
        pixels.of_8_bits.reset(
            stbi_load_from_memory(image.bytes, image.size, &width, &height, &channels, 0));
    if (!pixels.of_8_bits && !pixels.of_16_bits)
        fail(gltf.file, "images/" + std::to_string(index),
             "is neither PNG nor JPEG, or is damaged");
    pixels.count = std::size_t(width) * std::size_t(height);
    pixels.channels = std::size_t(channels);
    return pixels;
}

}  // namespace

void check_images(const GltfFile& gltf, const Json& materials) {
    std::set<ImageAverages::Place> places;
    std::uint64_t pixels = 0, bytes = 0;
    for (const Json& material : materials)
        for (const std::size_t index : images_of(gltf, material)) {
            if (!places.insert(place_of(gltf, index)).second) continue;
            const EncodedImage image = encoded(gltf, index);
            pixels += check_pixels(gltf.file, "images/" + std::to_string(index), image);
            bytes += std::uint64_t(image.size);
        }
    if (pixels <= kMostPixelsInAll + kPixelsOfAByte * bytes) return;
    fail(gltf.file, "images",
         "are " + std::to_string(pixels) + " pixels in all, more than the " +
             std::to_string(kMostPixelsInAll + kPixelsOfAByte * bytes) + " that are read of " +
             std::to_string(bytes) + " bytes");
}

Rgb image_average(ImageAverages& images, std::size_t index) {
    const ImageAverages::Place place = place_of(images.gltf, index);
    const auto known = images.known.find(place);
    if (known != images.known.end()) return known->second;
    const Pixels pixels = decoded(images.gltf, index);
    return images.known[place] = pixels.of_16_bits
                                     ? average<std::uint16_t>(pixels, pixels.of_16_bits.get())
                                     : average<std::uint8_t>(pixels, pixels.of_8_bits.get());
}

}  // namespace hemirad
