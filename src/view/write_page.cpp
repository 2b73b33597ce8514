#include "view/write_page.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "lightmap/atomic_file.h"
#include "lightmap/base64.h"
#include "lightmap/deflate.h"
#include "lightmap/tone.h"
#include "scene/bounds.h"
#include "view/false_colour.h"
#include "view/page_parts.h"

namespace hemirad {
namespace {

using Json = nlohmann::ordered_json;
using Bands = std::vector<std::vector<float>>;

template <class Value>
std::string packed(const std::vector<Value>& values) {
    return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)});
}

/// Three mantissas of 8 bits and an exponent: G. Ward, "Real Pixels", Graphics Gems II (1991).
std::array<unsigned char, 4> rgbe_of(const std::array<float, 3>& rgb) {
    const float largest = *std::ranges::max_element(rgb);
    if (!(largest > 1e-32f)) return {0, 0, 0, 0};
    int exponent = 0;
    std::frexp(largest, &exponent);
    std::array<unsigned char, 4> rgbe{};
    for (std::size_t i = 0; i < 3; ++i) {
        const float mantissa = std::ldexp(std::max(rgb[i], 0.0f), 8 - exponent);
        rgbe[i] = static_cast<unsigned char>(std::min(std::lround(mantissa), 255L));
    }
    rgbe[3] = static_cast<unsigned char>(std::clamp(exponent + 128, 1, 255));
    return rgbe;
}

std::string texels_of(const Bands& bands) {
    const ShownBands shown = shown_bands(bands.size());
    std::string bytes;
    bytes.reserve(4 * bands[0].size());
    for (std::size_t texel = 0; texel < bands[0].size(); ++texel)
        for (const unsigned char byte :
             rgbe_of({bands[shown[0]][texel], bands[shown[1]][texel], bands[shown[2]][texel]}))
            bytes += static_cast<char>(byte);
    return base64(deflated(bytes));
}

struct Ball {
    glm::dvec3 centre;
    double radius;
};

Ball around(const Scene& scene) {
    const Bounds bounds = bounds_of(scene);
    return {bounds.middle(), bounds.diagonal() / 2};
}

std::vector<double> shown_of(const std::vector<double>& spectrum) {
    const ShownBands shown = shown_bands(spectrum.size());
    return {spectrum[shown[0]], spectrum[shown[1]], spectrum[shown[2]]};
}

/// Three of its own to each face.
struct Vertices {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec2> uvs;
    std::map<std::uint32_t, std::vector<std::uint32_t>> of_material;
};

/// Coordinates from the middle of the scene, where floats are finest.
Vertices vertices_of(const Scene& scene, const Ball& ball) {
    Vertices vertices;
    for (const Face& face : scene.faces)
        for (std::size_t i = 0; i < 3; ++i) {
            vertices.of_material[face.material].push_back(
                static_cast<std::uint32_t>(vertices.positions.size()));
            vertices.positions.emplace_back(scene.positions[face.vertices[i]] - ball.centre);
            vertices.uvs.emplace_back(face.lightmap_uvs[i]);
        }
    return vertices;
}

void add_triangles(Json& json, const LitScene& lit, const Ball& ball) {
    const Vertices vertices = vertices_of(lit.scene, ball);
    json["positions"] = packed(vertices.positions);
    json["uvs"] = packed(vertices.uvs);
    json["materials"] = Json::array();
    for (const auto& [index, corners] : vertices.of_material) {
        const Material& material = lit.scene.materials[index];
        json["materials"].push_back({{"reflectance", shown_of(material.reflectance)},
                                     {"emission", shown_of(material.emission)},
                                     {"atlas", lit.atlas_of[index]},
                                     {"indices", packed(corners)}});
    }
}

Json vector_json(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

/// The point to turn about is as far ahead as the middle of the scene.
Json cameras_json(const LitScene& lit, const Ball& ball) {
    Json cameras = Json::array();
    for (const Camera& camera : lit.cameras) {
        const glm::dvec3 eye = camera.eye - ball.centre;
        const double ahead = std::max(-glm::dot(eye, camera.forward), 0.1 * ball.radius);
        cameras.push_back({{"name", camera.name},
                           {"eye", vector_json(eye)},
                           {"target", vector_json(eye + ahead * camera.forward)},
                           {"up", vector_json(camera.up)},
                           {"yfov", camera.yfov}});
    }
    return cameras;
}

/// What `value_of` makes of red, green and blue of each texel that shows something.
template <class ValueOf>
std::vector<double> of_texels(const LitScene& lit, const ValueOf& value_of) {
    const ShownBands shown = shown_bands(lit.scene.bands.size());
    std::vector<double> values;
    for (const Lightmap& lightmap : lit.lightmaps)
        for (std::size_t texel = 0; texel < lightmap.texel_count(); ++texel)
            if (lightmap.coverage[texel] > 0)
                values.push_back(value_of(double{lightmap.values[shown[0]][texel]},
                                          double{lightmap.values[shown[1]][texel]},
                                          double{lightmap.values[shown[2]][texel]}));
    return values;
}

/// Of all surfaces, by area.
double mean_reflectance(const Scene& scene) {
    double area = 0, reflected = 0;
    for (const Face& face : scene.faces) {
        const auto at = [&](std::size_t i) { return scene.positions[face.vertices[i]]; };
        const double own = glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
        const auto rgb = shown_of(scene.materials[face.material].reflectance);
        area += own;
        reflected += own * luminance(rgb[0], rgb[1], rgb[2]);
    }
    return std::max(reflected / area, 0.01);
}

double exposure_of(const LitScene& lit) {
    const double of_lightmap = exposure_for(of_texels(lit, luminance));
    const double reflected =
        lit.quantity == Quantity::radiosity ? 1.0 : mean_reflectance(lit.scene);
    return of_lightmap * std::numbers::pi / reflected;
}

double largest_of(const LitScene& lit) {
    const bool grey = lit.scene.bands.size() == 1;
    return scale_end(of_texels(lit, [&](double red, double green, double blue) {
        return (red + green + blue) / (grey ? 3 : 1);
    }));
}

/// By atlas.
Json texels_of(const std::vector<Lightmap>& lightmaps) {
    Json list = Json::array();
    for (const Lightmap& lightmap : lightmaps) list.push_back(texels_of(lightmap.values));
    return list;
}

bool is_in_all(const std::vector<Lightmap>& lightmaps, const std::string& layer) {
    return std::ranges::all_of(
        lightmaps, [&](const Lightmap& lightmap) { return lightmap.layers.contains(layer); });
}

Json layers_json(const std::vector<Lightmap>& lightmaps) {
    Json layers = Json::array();
    layers.push_back({{"name", "all"}, {"texels", texels_of(lightmaps)}});
    for (const auto& [name, layer] : lightmaps[0].layers) {
        if (!is_in_all(lightmaps, name)) continue;
        Json texels = Json::array();
        for (const Lightmap& lightmap : lightmaps)
            texels.push_back(texels_of(lightmap.layers.at(name).values));
        layers.push_back({{"name", name}, {"texels", std::move(texels)}});
    }
    return layers;
}

Json atlases_json(const std::vector<Lightmap>& lightmaps) {
    Json list = Json::array();
    for (const Lightmap& lightmap : lightmaps)
        list.push_back({{"width", lightmap.width}, {"height", lightmap.height}});
    return list;
}

Json snapshots_json(const std::vector<Snapshot>& snapshots) {
    Json list = Json::array();
    for (const Snapshot& snapshot : snapshots)
        list.push_back({{"shots", snapshot.shots}, {"texels", texels_of(snapshot.lightmaps)}});
    return list;
}

Json page_json(const LitScene& lit, const std::vector<Snapshot>& snapshots) {
    const Ball ball = around(lit.scene);
    Json json{{"name", lit.scene.file},
              {"quantity", lit.quantity == Quantity::radiosity ? "radiosity" : "irradiance"},
              {"isGrey", lit.scene.bands.size() == 1},
              {"radius", ball.radius},
              {"exposure", exposure_of(lit)},
              {"largest", largest_of(lit)},
              {"colours", std::vector<Colour>(false_colours().begin(), false_colours().end())}};
    json["cameras"] = cameras_json(lit, ball);
    json["atlases"] = atlases_json(lit.lightmaps);
    json["layers"] = layers_json(lit.lightmaps);
    json["snapshots"] = snapshots_json(snapshots);
    add_triangles(json, lit, ball);
    return json;
}

/// JSON that ends no script and begins no comment: "<" stands in its strings only.
std::string in_script(const Json& json) {
    std::string text;
    for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace))
        c == '<' ? text += "\\u003c" : text += c;
    return text;
}

/// The template up to each @NAME@, then that part; what is put in is not searched again.
void write_parts(std::ostream& stream, const std::string& scene) {
    std::string_view rest = page_part("page.html");
    for (auto at = rest.find('@'); at != rest.npos; at = rest.find('@')) {
        const auto end = rest.find('@', at + 1);
        const auto name = rest.substr(at + 1, end - at - 1);
        stream << rest.substr(0, at)
               << (name == "scene" ? std::string_view(scene) : page_part(name));
        rest.remove_prefix(end + 1);
    }
    stream << rest;
}

}  // namespace

void write_page(const std::filesystem::path& path, const LitScene& lit,
                const std::vector<Snapshot>& snapshots) {
    const std::string scene = in_script(page_json(lit, snapshots));
    write_atomically(path, [&](std::ostream& stream) { write_parts(stream, scene); });
}

}  // namespace hemirad
