#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include <stb/stb_image.h>

#include "scene/gltf_file.h"

namespace hemirad {
namespace {

using Rgb = std::array<double, 3>;

/// Half of 16384 x 16384: half a GiB while its average is taken. A few kilobytes of PNG may
/// announce a thousand times that.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 27;

/// More than spectra of 1 nm have; what is made of bands grows with their square.
constexpr std::size_t kMostBands = 1000;

struct Materials {
    const GltfFile& gltf;
    /// By where their bytes are: the same bytes in many images or bufferViews are decoded once.
    std::map<std::array<std::size_t, 3>, Rgb> image_averages = {};
};

// IEC 61966-2-1
double linear_from_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// How often each sample value occurs, per channel: the average then decodes each value once.
template <class Sample>
Rgb average(const tinygltf::Image& image) {
    constexpr std::size_t kValues = std::size_t{std::numeric_limits<Sample>::max()} + 1;
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    const auto channels = static_cast<std::size_t>(image.component);
    Rgb mean{};
    for (std::size_t channel = 0; channel < mean.size(); ++channel) {
        std::vector<std::uint64_t> counts(kValues);
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            Sample sample;
            std::memcpy(&sample, &image.image[(pixel * channels + channel) * sizeof sample],
                        sizeof sample);
            ++counts[sample];
        }
        for (std::size_t value = 0; value < kValues; ++value) {
            mean[channel] +=
                double(counts[value]) * linear_from_srgb(double(value) / double(kValues - 1));
        }
        mean[channel] /= double(pixels);
    }
    return mean;
}

void check_pixels(const GltfFile& gltf, const std::string& path, const unsigned char* bytes,
                  int size) {
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(bytes, size, &width, &height, &channels) == 0)
        fail(gltf.file, path, "is neither PNG nor JPEG, or is damaged");
    if (std::int64_t{width} * height <= kMostPixels) return;
    fail(gltf.file, path,
         "is " + std::to_string(width) + " x " + std::to_string(height) +
             " pixels, more than the " + std::to_string(kMostPixels) + " that are read");
}

tinygltf::Image decoded(const GltfFile& gltf, std::size_t index) {
    const auto& image = gltf.model.images[index];
    const auto* bytes = image.image.data();
    std::size_t size = image.image.size();
    if (image.bufferView >= 0) {
        const std::string_view view = view_bytes(gltf.model, image.bufferView);
        bytes = reinterpret_cast<const unsigned char*>(view.data());
        size = view.size();
    }
    const std::string path = "images/" + std::to_string(index);
    if (size == 0) fail(gltf.file, path, "cannot be read");
    check_pixels(gltf, path, bytes, static_cast<int>(size));
    tinygltf::Image pixels;
    std::string error, warning;
    if (!tinygltf::LoadImageData(&pixels, 0, &error, &warning, 0, 0, bytes, static_cast<int>(size),
                                 nullptr)) {
        fail(gltf.file, path, "is neither PNG nor JPEG, or is damaged");
    }
    return pixels;
}

Rgb image_average(Materials& materials, std::size_t index) {
    const auto& model = materials.gltf.model;
    const int view = model.images[index].bufferView;
    std::array<std::size_t, 3> key{index, 0, 0};  // no view is of 0 bytes
    if (view >= 0) {
        const auto& of = model.bufferViews[static_cast<std::size_t>(view)];
        key = {static_cast<std::size_t>(of.buffer), of.byteOffset, of.byteLength};
    }
    const auto known = materials.image_averages.find(key);
    if (known != materials.image_averages.end()) return known->second;
    const auto pixels = decoded(materials.gltf, index);
    return materials.image_averages[key] =
               pixels.bits == 16 ? average<std::uint16_t>(pixels) : average<std::uint8_t>(pixels);
}

/// The colour that a texture has from afar; white where there is none.
Rgb texture_average(Materials& materials, const Json& owner, const char* key) {
    const auto info = owner.find(key);
    if (info == owner.end() || !info->contains("index")) return {1, 1, 1};
    const auto index = (*info)["index"].get<std::size_t>();
    const GltfFile& gltf = materials.gltf;
    const Json& texture = gltf.json["textures"][index];
    if (!texture.contains("source")) {
        fail(gltf.file, "textures/" + std::to_string(index), "has no image");
    }
    return image_average(materials, texture["source"].get<std::size_t>());
}

std::vector<double> tinted(const Json& owner, const char* key, double missing, const Rgb& tint) {
    const auto factor = owner.find(key);
    std::vector<double> rgb(3);
    for (std::size_t band = 0; band < 3; ++band) {
        rgb[band] = tint[band] * (factor == owner.end() ? missing : (*factor)[band].get<double>());
    }
    return rgb;
}

double emissive_strength(const GltfFile& gltf, const Json& json, const std::string& element) {
    const auto extensions = json.find("extensions");
    if (extensions == json.end()) return 1;
    const auto extension = extensions->find("KHR_materials_emissive_strength");
    if (extension == extensions->end()) return 1;
    const auto strength = extension->find("emissiveStrength");
    if (strength == extension->end()) return 1;
    if (!strength->is_number()) fail(gltf.file, element, "emissiveStrength is no number");
    return strength->get<double>();
}

std::string material_name(const Json& json, std::size_t index) {
    const auto name = json.find("name");
    const bool named =
        name != json.end() && name->is_string() && !name->get_ref<const std::string&>().empty();
    return named ? printable(name->get_ref<const std::string&>())
                 : "material" + std::to_string(index);
}

bool is_true(const Json& json, const char* key) {
    const auto value = json.find(key);
    return value != json.end() && value->is_boolean() && value->get<bool>();
}

Material rgb_material(Materials& materials, const Json& json, const std::string& name) {
    static const Json kNothing = Json::object();
    const auto found = json.find("pbrMetallicRoughness");
    const Json& pbr = found == json.end() ? kNothing : *found;
    const double strength = emissive_strength(materials.gltf, json, "material " + in_quotes(name));
    Material material{name, {}, {}, is_true(json, "doubleSided")};
    material.reflectance =
        tinted(pbr, "baseColorFactor", 1, texture_average(materials, pbr, "baseColorTexture"));
    material.emission =
        tinted(json, "emissiveFactor", 0, texture_average(materials, json, "emissiveTexture"));
    for (double& radiance : material.emission) radiance *= strength;
    return material;
}

/// extras.reflectance or extras.emission of a material, nullptr if it has none.
const Json* spectrum(const Json& json, const char* key) {
    const auto extras = json.find("extras");
    if (extras == json.end()) return nullptr;
    const auto found = extras->find(key);
    return found != extras->end() && found->is_object() ? &*found : nullptr;
}

/// The names in the spectra of all materials, in order of first appearance.
std::vector<std::string> named_bands(const GltfFile& gltf, const Json& materials) {
    std::vector<std::string> bands;
    for (const Json& material : materials) {
        for (const char* key : {"reflectance", "emission"}) {
            const Json* values = spectrum(material, key);
            if (values == nullptr) continue;
            for (const auto& [band, value] : values->items()) {
                if (std::find(bands.begin(), bands.end(), band) == bands.end()) {
                    bands.push_back(band);
                }
                if (bands.size() > kMostBands)
                    fail(gltf.file, "materials",
                         "name more than " + std::to_string(kMostBands) + " bands");
            }
        }
    }
    return bands;
}

double band_value(const GltfFile& gltf, const std::string& name, const Json* values,
                  const char* key, const std::string& band) {
    const std::string element = "material " + in_quotes(name);
    const bool present = values != nullptr && values->contains(band);
    if (!present && std::string_view(key) == "emission") return 0;
    if (!present)
        fail(gltf.file, element, "extras hold no reflectance for band " + in_quotes(band));
    if (!(*values)[band].is_number()) {
        fail(gltf.file, element,
             std::string(key) + " of band " + in_quotes(band) + " is no number");
    }
    return (*values)[band].get<double>();
}

Material spectral_material(const GltfFile& gltf, const Json& json, const std::string& name,
                           const std::vector<std::string>& bands) {
    Material material{name, {}, {}, is_true(json, "doubleSided")};
    for (const auto& band : bands) {
        material.reflectance.push_back(
            band_value(gltf, name, spectrum(json, "reflectance"), "reflectance", band));
        material.emission.push_back(
            band_value(gltf, name, spectrum(json, "emission"), "emission", band));
    }
    return material;
}

void warn_of_transparency(const Json& json, const std::string& name, Scene& scene) {
    const auto mode = json.find("alphaMode");
    if (mode == json.end() || *mode == "OPAQUE") return;
    warn(scene, "material " + in_quotes(name), "alphaMode is not read, the material is opaque");
}

}  // namespace

void read_gltf_materials(const GltfFile& gltf, Scene& scene) {
    const Json none = Json::array();
    const auto found = gltf.json.find("materials");
    const Json& list = found == gltf.json.end() ? none : *found;
    const std::vector<std::string> bands = named_bands(gltf, list);
    Materials materials{gltf};
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string name = material_name(list[i], i);
        warn_of_transparency(list[i], name, scene);
        scene.materials.push_back(bands.empty() ? rgb_material(materials, list[i], name)
                                                : spectral_material(gltf, list[i], name, bands));
    }
    scene.bands = {"R", "G", "B"};
    if (bands.empty()) return;
    scene.bands.clear();
    for (const auto& band : bands) scene.bands.push_back(printable(band));
}

Material default_gltf_material(const GltfFile& gltf, const Scene& scene) {
    if (scene.bands != std::vector<std::string>{"R", "G", "B"}) {
        fail(gltf.file, "material \"default\"",
             "a primitive without a material has no reflectance for the named bands");
    }
    return {"default", std::vector(3, 1.0), std::vector(3, 0.0), false};
}

}  // namespace hemirad
