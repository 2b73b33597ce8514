#include <algorithm>

#include "scene/gltf_file.h"
#include "scene/gltf_image.h"

namespace hemirad {
namespace {

/// More than spectra of 1 nm have; what is made of bands grows with their square.
constexpr std::size_t kMostBands = 1000;

/// The colour that a texture has from afar; white where there is none.
Rgb texture_average(ImageAverages& images, const Json& owner, const char* key) {
    const auto info = owner.find(key);
    if (info == owner.end() || !info->contains("index")) return {1, 1, 1};
    const auto index = (*info)["index"].get<std::size_t>();
    const GltfFile& gltf = images.gltf;
    const Json& texture = gltf.json["textures"][index];
    if (!texture.contains("source")) {
        fail(gltf.file, "textures/" + std::to_string(index), "has no image");
    }
    return image_average(images, texture["source"].get<std::size_t>());
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

std::string material_name(const InputFile& file, const Json& json, std::size_t index) {
    const auto found = json.find("name");
    const bool is_text = found != json.end() && found->is_string();
    const std::string name = is_text ? found->get<std::string>() : std::string{};
    check_name(file, "material", name);
    return name.empty() ? "material" + std::to_string(index) : printable(name);
}

bool is_true(const Json& json, const char* key) {
    const auto value = json.find(key);
    return value != json.end() && value->is_boolean() && value->get<bool>();
}

Material rgb_material(ImageAverages& images, const Json& json, const std::string& name) {
    static const Json kNothing = Json::object();
    const auto found = json.find("pbrMetallicRoughness");
    const Json& pbr = found == json.end() ? kNothing : *found;
    const double strength = emissive_strength(images.gltf, json, "material " + in_quotes(name));
    Material material{name, {}, {}, is_true(json, "doubleSided")};
    material.reflectance =
        tinted(pbr, "baseColorFactor", 1, texture_average(images, pbr, "baseColorTexture"));
    material.emission =
        tinted(json, "emissiveFactor", 0, texture_average(images, json, "emissiveTexture"));
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
                check_name(gltf.file, "band", band);
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

/// Its diffuse colour is what such materials have to say of reflectance. Once a file.
void warn_of_specular_glossiness(const GltfFile& gltf, const Json& materials, Scene& scene) {
    static const Json::json_pointer kExtension("/extensions/KHR_materials_pbrSpecularGlossiness");
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (!materials[i].contains(kExtension)) continue;
        const std::string name = in_quotes(material_name(gltf.file, materials[i], i));
        return warn(scene, kExtension.back(),
                    "is not read, materials have the base colour beside it, or white (material " +
                        name + ")");
    }
}

}  // namespace

void read_gltf_materials(const GltfFile& gltf, Scene& scene) {
    const Json none = Json::array();
    const auto found = gltf.json.find("materials");
    const Json& list = found == gltf.json.end() ? none : *found;
    const std::vector<std::string> bands = named_bands(gltf, list);
    if (bands.empty()) {
        check_images(gltf, list);
        warn_of_specular_glossiness(gltf, list, scene);
    }
    ImageAverages images{gltf};
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string name = material_name(gltf.file, list[i], i);
        warn_of_transparency(list[i], name, scene);
        scene.materials.push_back(bands.empty() ? rgb_material(images, list[i], name)
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
