#include <algorithm>
#include <cstdint>

#include "fuzz/answers.h"
#include "fuzz/targets.h"
#include "lightmap/chart_layout.h"
#include "lightmap/lightmap_uvs.h"
#include "scene/mesh.h"
#include "solver/contacts.h"
#include "solver/find_rims.h"
#include "solver/near_pairs.h"
#include "solver/patch_arrays.h"

namespace hemirad::fuzz {
namespace {

/// Bytes taken off the front; zeros behind the last.
class Bytes {
  public:
    explicit Bytes(std::string_view bytes) : rest_(bytes) {}

    std::uint32_t next() {
        if (rest_.empty()) return 0;
        const auto byte = static_cast<unsigned char>(rest_[0]);
        rest_.remove_prefix(1);
        return byte;
    }
    bool any() const { return !rest_.empty(); }

  private:
    std::string_view rest_;
};

constexpr std::uint32_t kMostPositions = 24, kMostFaces = 24;

/// On a grid of eighths, so that faces meet and lie on each other; now and then a little off it.
double coordinate(Bytes& bytes) {
    const std::uint32_t byte = bytes.next();
    const double at = (byte & 15u) / 8.0;
    return at + (byte >> 6 == 3 ? std::ldexp(1.0, -int(byte & 63u)) : 0.0);
}

/// By the scene, up to a thousand orders away from a metre.
double scale_of(std::uint32_t byte) {
    return byte < 128 ? 1.0 : std::ldexp(1.0, (int(byte) - 192) * 4);
}

Scene scene_of(Bytes& bytes) {
    Scene scene;
    scene.file = "bytes";
    scene.bands = {"grey"};
    scene.materials = {{"white", {0.5}, {0}}, {"lamp", {0}, {1}}, {"sheet", {0.5}, {0}, true}};
    scene.objects = {"a", "b"};
    const double scale = scale_of(bytes.next());
    const std::uint32_t positions = 3 + bytes.next() % (kMostPositions - 2);
    for (std::uint32_t i = 0; i < positions; ++i) {
        const double x = coordinate(bytes), y = coordinate(bytes), z = coordinate(bytes);
        scene.positions.emplace_back(scale * x, scale * y, scale * z);
    }
    while (bytes.any() && scene.faces.size() < kMostFaces) {
        const std::uint32_t kind = bytes.next();
        Face face{{}, kind / 8 % 3, kind / 64 % 2};
        for (std::uint32_t i = 0; i < 3 + kind % 4; ++i)
            face.vertices.push_back(bytes.next() % positions);
        scene.faces.push_back(face);
    }
    return scene;
}

MeshSettings settings_of(Bytes& bytes, const Scene& scene) {
    MeshSettings settings;
    const std::uint32_t kind = bytes.next();
    const double size = default_patch_size(scene);
    settings.patch_size = kind % 3 == 0 ? INFINITY : size * 4;  // few patches
    if (kind % 3 == 2) settings.element_size = size * 2;
    settings.split_levels = kind / 4 % 3;
    settings.backfaces = static_cast<Backfaces>(kind / 16 % 3);
    if (kind >= 128) settings.weld = size / 16;
    return settings;
}

void require_mesh(const Mesh& mesh) {
    for (const Patch& patch : mesh.patches) {
        for (const auto corner : patch.corners)
            require(corner < mesh.vertices.size(), "corners in range");
        require(patch.surface < mesh.surfaces.size(), "surfaces in range");
        require(mesh.area(patch) > 0, "patches with an area");
    }
    for (const Fragment& fragment : mesh.fragments)
        require(fragment.patch < mesh.patches.size(), "fragments of patches");
}

void set_up(const Scene& scene, const Mesh& mesh) {
    const ChartLayout layout = lay_out_charts(scene, mesh, {});
    for (const UvTriangle& triangle : lightmap_uvs(scene, mesh, layout))
        for (const auto& uv : triangle.uvs)
            require(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1, "charts in the atlas");
    const PatchArrays arrays = patch_arrays(mesh);
    require(find_rims(mesh, arrays.corner_count).size() == mesh.patches.size(), "rims of patches");
    clusters_of(arrays);
    shooter_arrays(mesh, arrays);
    contacts(mesh, patch_shapes(mesh));
    near_pairs(mesh, 0.1);
}

}  // namespace

void build_mesh_bytes(std::string_view text) {
    answer([&] {
        Bytes bytes(text);
        const std::uint32_t kind = bytes.next();
        const Scene scene = scene_of(bytes);
        const std::string of_settings(1, static_cast<char>(kind));
        Bytes rest(of_settings);
        if (scene.faces.empty()) return;
        const MeshSettings settings = settings_of(rest, scene);
        const Mesh mesh = build_mesh(scene, settings);
        require_mesh(mesh);
        set_up(scene, mesh);
        if (settings.split_levels == 0) return;
        const Mesh split =
            split_mesh(scene, settings, mesh, {std::vector<bool>(mesh.patches.size(), true)});
        require_mesh(split);
        set_up(scene, split);
    });
}

}  // namespace hemirad::fuzz
