#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "scene/input_file.h"

namespace hemirad {

/// Keeps the file's order, which is the bands' order.
using Json = nlohmann::ordered_json;

/// A glTF 2.0 file, read twice: as JSON, checked before tinygltf (which trusts its input) follows
/// any of its references, and as tinygltf's model with the buffers loaded. Images stay encoded,
/// in Image::image, until a material asks for them.
struct GltfFile {
    const InputFile& file;
    Json json;
    tinygltf::Model model;
    std::set<std::filesystem::path> side_files = {};  ///< that were read besides `file`
};

/// Throws InputError. Every index of the result is in range, every bufferView inside its buffer.
GltfFile load_gltf(const InputFile& file);

/// What load_gltf checks before it hands the file to tinygltf.
void check_gltf(const InputFile& file, const Json& json);

/// The accessor's values, `components` to an element, normalised integers as fractions, sparse ones
/// filled in. Throws InputError where they do not lie inside their bufferView or are of another
/// type.
std::vector<double> read_accessor(const GltfFile& gltf, int accessor, int components);

/// The bytes of a bufferView.
std::string_view view_bytes(const tinygltf::Model& model, int view);

/// Bands, and a material for each of the file's, spectra unchecked.
void read_gltf_materials(const GltfFile& gltf, Scene& scene);
/// What glTF says of primitives without a material: white.
Material default_gltf_material(const GltfFile& gltf, const Scene& scene);

}  // namespace hemirad
