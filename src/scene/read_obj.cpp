#include <tiny_obj_loader.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/input_file.h"
#include "scene/obj_numbers.h"

namespace hemirad {
namespace {

// Of a face whose material is unknown: between black and white, so that light still bounces.
constexpr double kUnknownReflectance = 0.5;

struct ObjFile {
    const InputFile& file;
    ObjNumbers numbers;
    Scene scene = {};

    std::size_t vertex_count = 0;  // read so far: relative indices count back from here
    std::size_t face_count = 0;
    std::string object = {}, group = {}, material = {};
    std::set<std::filesystem::path> libraries = {};  ///< read: again they would add nothing
    std::map<std::string, tinyobj::material_t> library = {};
    std::map<std::string, tinyobj::material_t> commented = {};  ///< by name without comment
    std::map<std::pair<std::string, std::string>, std::uint32_t> object_indices = {};
    std::map<std::string, std::uint32_t> material_indices = {};
};

std::string trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t");
    if (begin == text.npos) return {};
    return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

Material unknown_material(ObjFile& obj) {
    const std::string stand_in =
        "grey of reflectance " + number(kUnknownReflectance) + " stands in";
    if (obj.material.empty()) {
        warn(obj.scene, "faces without a material", stand_in);
    } else {
        warn(obj.scene, "material " + in_quotes(obj.material), "is not defined, " + stand_in);
    }
    const std::string name = obj.material.empty() ? "default" : printable(obj.material);
    return {name, std::vector(3, kUnknownReflectance), std::vector(3, 0.0), false};
}

Material known_material(ObjFile& obj, const tinyobj::material_t& from) {
    const std::string name = printable(from.name), element = "material " + in_quotes(from.name);
    if (!from.diffuse_texname.empty())
        warn(obj.scene, element, "map_Kd is not read, Kd stands alone");
    if (!from.emissive_texname.empty())
        warn(obj.scene, element, "map_Ke is not read, Ke stands alone");
    if (from.dissolve < 1)
        warn(obj.scene, element, "d and Tr are not read, the material is opaque");
    return {name, {from.diffuse, from.diffuse + 3}, {from.emission, from.emission + 3}, false};
}

/// As its library has it, or nothing.
const tinyobj::material_t* definition_of(const ObjFile& obj) {
    for (const auto* library : {&obj.library, &obj.commented})
        if (const auto found = library->find(obj.material); found != library->end())
            return &found->second;
    return nullptr;
}

std::uint32_t material_index(ObjFile& obj) {
    const auto next = static_cast<std::uint32_t>(obj.scene.materials.size());
    const auto [entry, is_new] = obj.material_indices.try_emplace(obj.material, next);
    if (is_new) {
        const auto* known = definition_of(obj);
        obj.scene.materials.push_back(known == nullptr ? unknown_material(obj)
                                                       : known_material(obj, *known));
    }
    return entry->second;
}

std::uint32_t object_index(ObjFile& obj) {
    const auto next = static_cast<std::uint32_t>(obj.scene.objects.size());
    const auto [entry, is_new] = obj.object_indices.try_emplace({obj.object, obj.group}, next);
    if (is_new) {
        const std::string& name = obj.group.empty() ? obj.object : obj.group;
        obj.scene.objects.push_back(name.empty() ? "default" : printable(name));
    }
    return entry->second;
}

std::uint32_t vertex_index(const ObjFile& obj, int index) {
    const auto count = static_cast<long long>(obj.numbers.positions.size());
    const auto read = static_cast<long long>(obj.vertex_count);
    const long long vertex = index < 0 ? read + index : index - 1LL;
    if (vertex < 0 || vertex >= count) {
        fail(obj.file, "line " + std::to_string(obj.numbers.face_lines[obj.face_count]),
             "vertex " + std::to_string(index) + " is out of range, the file holds " +
                 std::to_string(count));
    }
    return static_cast<std::uint32_t>(vertex);
}

void add_face(ObjFile& obj, const tinyobj::index_t* corners, int count) {
    Face face;
    face.vertices.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
        face.vertices.push_back(vertex_index(obj, corners[i].vertex_index));
    }
    face.material = material_index(obj);
    face.object = object_index(obj);
    obj.scene.faces.push_back(std::move(face));
    ++obj.face_count;
}

void set_group(ObjFile& obj, const char** names, int count) {
    obj.group.clear();
    for (int i = 0; i < count; ++i) {
        if (i > 0) obj.group += ' ';
        obj.group += names[i];
    }
    check_name(obj.file, "group", obj.group);
}

/// They are not read, but the scene's: relative to the library.
void note_textures(ObjFile& obj, const std::filesystem::path& library,
                   const tinyobj::material_t& material) {
    for (const auto* name :
         {&material.ambient_texname, &material.diffuse_texname, &material.specular_texname,
          &material.specular_highlight_texname, &material.bump_texname,
          &material.displacement_texname, &material.alpha_texname, &material.reflection_texname,
          &material.roughness_texname, &material.metallic_texname, &material.sheen_texname,
          &material.emissive_texname, &material.normal_texname})
        if (!name->empty())
            obj.scene.side_files.push_back((library.parent_path() / trimmed(*name)).string());
}

void add_material(ObjFile& obj, const std::string& name, tinyobj::material_t material) {
    if (name.empty()) return;  // lines before any newmtl
    obj.library.emplace(name, material);
    const std::string cut = trimmed(without_comment(name));
    if (cut == name) return;
    material.name = cut;
    obj.commented.emplace(cut, std::move(material));
}

void read_library(ObjFile& obj, const std::string& reference, const std::filesystem::path& path) {
    const InputFile file = read_input_file(path);
    const std::string text = spell_out_colours(file, unfold_lines(file.bytes));

    std::map<std::string, int> indices;
    std::vector<tinyobj::material_t> materials;
    std::istringstream stream(text);
    std::string warning, error;
    tinyobj::LoadMtl(&indices, &materials, &stream, &warning, &error);
    if (!error.empty()) fail(obj.file, "mtllib " + in_quotes(reference), printable(error));
    obj.scene.side_files.push_back(path.string());
    for (const auto& material : materials) note_textures(obj, path, material);
    for (const auto& [name, index] : indices)
        add_material(obj, trimmed(name), materials[static_cast<std::size_t>(index)]);
}

/// A backslash makes the next character, a blank, a part of the name.
std::vector<std::string> names_in(std::string_view line) {
    std::vector<std::string> names(1);
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool is_blank = line[i] == ' ' || line[i] == '\t';
        if (line[i] == '\\' && i + 1 < line.size())
            names.back() += line[++i];
        else if (!is_blank)
            names.back() += line[i];
        else if (!names.back().empty())
            names.emplace_back();
    }
    if (names.back().empty()) names.pop_back();
    return names;
}

/// One file whose name has blanks, if there is such a file, or several.
std::vector<std::string> libraries_in(const ObjFile& obj, const std::string& line) {
    for (const std::string& name : {trimmed(line), trimmed(without_comment(line))}) {
        const auto path = resolve_reference(obj.file, name);
        if (path && std::filesystem::is_regular_file(status_of(*path))) return {name};
    }
    return names_in(without_comment(line));
}

void read_once(ObjFile& obj, const std::string& reference) {
    const std::string element = "mtllib " + in_quotes(reference);
    const auto path = resolve_reference(obj.file, reference);
    if (!path) fail(obj.file, element, "must be a file in the scene's folder");
    if (!obj.libraries.insert(*path).second) return;
    if (std::filesystem::exists(status_of(*path)))
        read_library(obj, reference, *path);
    else
        warn(obj.scene, element, "does not exist");
}

/// A name that is defined as it is goes first: what looks like a comment may be part of it.
std::string name_in(const ObjFile& obj, const std::string& line) {
    const std::string name = trimmed(line), cut = trimmed(without_comment(name));
    return !obj.library.contains(name) && obj.library.contains(cut) ? cut : name;
}

ObjFile& obj_of(void* user_data) { return *static_cast<ObjFile*>(user_data); }

tinyobj::callback_t callbacks() {
    tinyobj::callback_t callback;
    callback.vertex_cb = [](void* user_data, double, double, double, double) {
        ++obj_of(user_data).vertex_count;
    };
    callback.index_cb = [](void* user_data, tinyobj::index_t* corners, int count) {
        add_face(obj_of(user_data), corners, count);
    };
    callback.usemtl_cb = [](void* user_data, const char* name, int) {
        obj_of(user_data).material = name_in(obj_of(user_data), name);
        check_name(obj_of(user_data).file, "material", obj_of(user_data).material);
    };
    callback.group_cb = [](void* user_data, const char** names, int count) {
        set_group(obj_of(user_data), names, count);
    };
    callback.object_cb = [](void* user_data, const char* name) {
        obj_of(user_data).object = trimmed(name);
        check_name(obj_of(user_data).file, "object", obj_of(user_data).object);
        obj_of(user_data).group.clear();
    };
    return callback;
}

/// Of the positions that faces use: one that is far off tells nothing of the others.
double quantum_of(const ObjFile& obj) {
    TextQuantum quantum;
    for (const Face& face : obj.scene.faces)
        for (const std::uint32_t v : face.vertices) quantum.add(obj.numbers.quanta[v]);
    return quantum.value();
}

}  // namespace

Scene read_obj(const InputFile& file) {
    const std::string text = unfold_lines(file.bytes);
    ObjFile obj{.file = file, .numbers = read_obj_numbers(file, text)};
    obj.scene.file = file.name;
    obj.scene.bands = {"R", "G", "B"};

    for (const std::string& line : obj.numbers.libraries)
        for (const std::string& name : libraries_in(obj, line)) read_once(obj, name);
    std::istringstream stream(text);
    std::string warning, error;
    tinyobj::LoadObjWithCallback(stream, callbacks(), &obj, nullptr, &warning, &error);
    if (!error.empty()) fail(file, "OBJ", printable(error));
    obj.scene.quantum = quantum_of(obj);
    obj.scene.positions = std::move(obj.numbers.positions);
    return std::move(obj.scene);
}

}  // namespace hemirad
