#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "scene/gltf_file.h"

namespace hemirad {
namespace {

// Deeper than any exporter nests; tinygltf descends into extras by recursion.
constexpr std::size_t kDeepestNesting = 200;
// More than exporters write; an ordered object compares a new member with all before it, which
// takes a second for the largest, and for as many compared in all.
constexpr std::size_t kMostMembers = 10'000;
constexpr std::size_t kMostCompared = kMostMembers * kMostMembers, kComparedAByte = 20;
// An object is held twice, a node in a thousand bytes: a small one of a mesh has 12 in the file.
constexpr std::size_t kFewObjects = 10'000, kBytesAnObject = 12;
constexpr std::size_t kHeaderSize = 12, kChunkHeaderSize = 8;  // glTF 2.0, sec. 4.4

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
    const auto byte = [&](std::size_t i) {
        return std::uint32_t{static_cast<unsigned char>(bytes[offset + i])};
    };
    return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

bool is_binary(const InputFile& file) { return file.bytes.starts_with("glTF"); }

void check_header(const InputFile& file) {
    const std::size_t size = file.bytes.size();
    if (size < kHeaderSize + kChunkHeaderSize) fail(file, "glb header", "is truncated");
    const std::uint32_t length = word_at(file.bytes, 8);
    if (word_at(file.bytes, 4) != 2) fail(file, "glb header", "is not of version 2");
    if (length > size) {
        fail(file, "glb header",
             "announces " + std::to_string(length) + " bytes, the file holds " +
                 std::to_string(size));
    }
}

std::string_view json_text(const InputFile& file) {
    if (!is_binary(file)) return file.bytes;
    check_header(file);
    const std::size_t length = word_at(file.bytes, kHeaderSize);
    const std::size_t begin = kHeaderSize + kChunkHeaderSize;
    if (length > file.bytes.size() - begin) fail(file, "glb JSON chunk", "is truncated");
    return std::string_view(file.bytes).substr(begin, length);
}

/// What a JSON text opens and how much it holds, as it is walked.
struct Shape {
    std::vector<std::size_t> commas;  ///< in what is open
    std::vector<bool> is_object;
    std::size_t objects = 0;
    std::size_t compared = 0;  ///< squares of closed objects' members

    void open(bool object) {
        commas.push_back(0);
        is_object.push_back(object);
        objects += object;
    }
    void close() {
        if (is_object.back()) compared += commas.back() * commas.back();
        commas.pop_back();
        is_object.pop_back();
    }
};

void check_members(const InputFile& file, const Shape& shape) {
    if (!shape.is_object.back() || shape.commas.back() < kMostMembers) return;
    fail(file, "JSON", "an object holds more than " + std::to_string(kMostMembers) + " members");
}

void check_amounts(const InputFile& file, const Shape& shape, std::size_t bytes) {
    const std::size_t objects = kFewObjects + bytes / kBytesAnObject;
    const std::size_t compared = kMostCompared + kComparedAByte * bytes;
    const std::string of_bytes = " that are read of " + std::to_string(bytes) + " bytes";
    if (shape.objects > objects)
        fail(file, "JSON",
             "holds " + std::to_string(shape.objects) + " objects, more than the " +
                 std::to_string(objects) + of_bytes);
    if (shape.compared > compared)
        fail(file, "JSON",
             "its objects hold too many members: squared and added up " +
                 std::to_string(shape.compared) + ", more than the " + std::to_string(compared) +
                 of_bytes);
}

/// Brackets and commas that do not stand in a string.
void check_shape(const InputFile& file, std::string_view text) {
    Shape shape;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\') ++i;
        if (c == '"') in_string = !in_string;
        if (in_string) continue;
        if (c == '{' || c == '[') shape.open(c == '{');
        if (shape.commas.size() > kDeepestNesting) fail(file, "JSON", "is nested too deeply");
        if (shape.commas.empty()) continue;
        if (c == '}' || c == ']') shape.close();
        if (c != ',' || shape.commas.empty()) continue;
        ++shape.commas.back();
        check_members(file, shape);
    }
    check_amounts(file, shape, text.size());
}

// tinygltf quotes whole data URIs.
constexpr std::size_t kLongestMessage = 200;

/// nlohmann and tinygltf write several lines and prefixes; ours are one line.
std::string one_line(const std::string& message) {
    std::string line = message.substr(0, message.find_first_of("\r\n"));
    if (line.size() > kLongestMessage) line = line.substr(0, kLongestMessage) + "...";
    const auto prefix = line.starts_with("[json") ? line.find("] ") : std::string::npos;
    if (prefix != std::string::npos) line.erase(0, prefix + 2);
    return printable(line);
}

/// A byte order mark is what some editors put before it.
bool begins_as_json(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const auto first = text.find_first_not_of(" \t\r\n");
    return first != text.npos &&
           std::string_view("{[\"0123456789-tfn").find(text[first]) != text.npos;
}

Json parse_json(const InputFile& file) {
    const std::string_view text = json_text(file);
    if (!begins_as_json(text)) fail(file, "glTF", "starts neither as GLB nor as JSON");
    check_shape(file, text);
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        fail(file, "JSON", one_line(error.what()));
    }
}

struct Folder {
    std::filesystem::path path;
    std::set<std::filesystem::path> read = {};
    std::uint64_t read_again = 0;  ///< bytes of files that were read before
};

/// Buffers, and images, may share a file, and each holds it whole.
constexpr std::uint64_t kMostReadAgain = std::uint64_t{1} << 28;

/// What tinygltf may read: files in the scene's folder, or nothing. It also looks in the working
/// directory and decodes %-escapes after check_gltf has seen the reference. The kernel would take
/// `link/..` for the folder above where the link leads: so it gets no such path.
std::optional<std::filesystem::path> place_in(const std::filesystem::path& folder,
                                              const std::string& path) {
    const auto relative = std::filesystem::path(path).lexically_normal().lexically_relative(
        folder.lexically_normal());
    if (relative.empty() || *relative.begin() == "..") return {};
    const auto place = folder / relative;
    if (!std::filesystem::is_regular_file(status_of(place))) return {};
    return place;
}

bool may_read(const std::string& path, void* folder) {
    return place_in(static_cast<const Folder*>(folder)->path, path).has_value();
}

bool is_read_rarely(Folder& folder, const std::filesystem::path& place) {
    if (folder.read.insert(place).second) return true;
    folder.read_again += std::filesystem::file_size(place);
    return folder.read_again <= kMostReadAgain;
}

bool read_whole(std::vector<unsigned char>* bytes, std::string* error, const std::string& path,
                void* of_scene) {
    Folder& folder = *static_cast<Folder*>(of_scene);
    const auto place = place_in(folder.path, path);
    std::ifstream stream;
    if (place) stream.open(*place, std::ios::binary);
    if (!stream.is_open() || !is_read_rarely(folder, *place)) {
        *error += "cannot be read";
        return false;
    }
    bytes->resize(std::filesystem::file_size(*place));
    stream.read(reinterpret_cast<char*>(bytes->data()),
                static_cast<std::streamsize>(bytes->size()));
    bytes->resize(static_cast<std::size_t>(stream.gcount()));
    return true;
}

std::string keep_path(const std::string& path, void*) { return path; }

/// Called for every image; tinygltf does not check bytes that lie in a bufferView, so those are
/// left for view_bytes.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    return true;
}

bool load_model(const InputFile& file, tinygltf::Model& model, Folder& folder, std::string& error) {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    loader.SetFsCallbacks({may_read, keep_path, read_whole, nullptr, &folder});
    std::string warning;
    const auto size = static_cast<unsigned>(file.bytes.size());
    if (is_binary(file)) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(file.bytes.data());
        return loader.LoadBinaryFromMemory(&model, &error, &warning, bytes, size,
                                           folder.path.string());
    }
    return loader.LoadASCIIFromString(&model, &error, &warning, file.bytes.data(), size,
                                      folder.path.string());
}

}  // namespace

GltfFile load_gltf(const InputFile& file) {
    if (file.bytes.size() > UINT32_MAX) fail(file, "glTF", "files above 4 GiB are not read");
    GltfFile gltf{file, parse_json(file), {}};
    check_gltf(file, gltf.json);
    Folder folder{file.path.parent_path()};
    if (folder.path.empty()) folder.path = ".";
    std::string error;
    bool loaded = false;
    try {
        loaded = load_model(file, gltf.model, folder, error);
    } catch (const std::exception& exception) {  // of tinygltf's at() and of its JSON
        error = exception.what();
    }
    if (!loaded) fail(file, "glTF", error.empty() ? "cannot be read" : one_line(error));
    gltf.side_files = std::move(folder.read);
    return gltf;
}

std::string_view view_bytes(const tinygltf::Model& model, int view) {
    const auto& buffer_view = model.bufferViews[static_cast<std::size_t>(view)];
    const auto& bytes = model.buffers[static_cast<std::size_t>(buffer_view.buffer)].data;
    return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())
        .substr(buffer_view.byteOffset, buffer_view.byteLength);
}

}  // namespace hemirad
