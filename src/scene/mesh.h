#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace hemirad {

/// A planar convex quad or triangle on which radiosity is constant (sec. 1.2).
struct Patch {
    /// Counter-clockwise from the front, indices into Mesh::vertices. A triangle repeats its last
    /// corner: corners[3] == corners[2].
    std::array<std::uint32_t, 4> corners;
    std::uint32_t surface;

    bool is_triangle() const { return corners[3] == corners[2]; }
};

/// Patches that shoot as one: a patch of Cohen et al.'s two levels, whose elements they are. Planar
/// and convex like them, and their union.
struct Shooter {
    std::array<std::uint32_t, 4> corners;  ///< as Patch::corners
    std::uint32_t surface;
    std::uint32_t first_patch, patch_count;
    std::uint32_t splits = 0;  ///< how often split_mesh() has split what it is a part of
};

inline constexpr std::uint32_t kOwnPlane = 0xffffffffu;
inline constexpr std::uint32_t kNoReverse = 0xffffffffu;

/// A line on a surface, in metres along its axes (s, t), on which others stand.
struct Wall {
    glm::dvec2 from, to;
};

/// Coplanar, connected faces of one object and one material, cut into a regular grid: of elements,
/// where shooters have several.
/// A point of the surface is origin + s * u_axis + t * v_axis with 0 <= s <= columns * cell_size.x
/// and 0 <= t <= rows * cell_size.y; (u_axis, v_axis, normal) is orthonormal and right-handed.
struct Surface {
    std::uint32_t object = 0;
    std::uint32_t material = 0;  ///< index into Mesh::materials
    bool is_back = false;        ///< the reverse of an open sheet or of a double-sided material
    bool has_chart = true;       ///< false for backs that only block and absorb
    std::uint32_t reverse = kNoReverse;  ///< of a front, the surface that is its back
    /// Surfaces of the same number lie in one plane, either way up, and see nothing of each other;
    /// kOwnPlane: no other does.
    std::uint32_t plane = kOwnPlane;
    glm::dvec3 origin{}, u_axis{}, v_axis{}, normal{};
    glm::dvec2 cell_size{};
    std::uint32_t columns = 1, rows = 1;
    std::uint32_t first_patch = 0, patch_count = 0;  ///< its patches are consecutive
    /// For each of its patches the grid cell it lies in, row * columns + column. A cell that the
    /// outline cuts, or that of another surface in its plane, holds several patches, one outside
    /// the outline none.
    std::vector<std::uint32_t> cell_of_patch;
    /// Where patches were split: for each the power of two of cells a side that it covers, from its
    /// cell to the right and upwards. Empty: one cell each.
    std::vector<std::uint8_t> scale_of_patch;
    /// Where other surfaces stand on it: patches near each other of which one is under what stands
    /// there and one beside it, or which it parts, have different sides. Empty: one side.
    std::vector<std::uint8_t> side_of_patch;
    /// Where other surfaces stand on it, on its outline, too: light may differ across.
    std::vector<Wall> walls;

    std::uint32_t scale(std::uint32_t i) const {
        return scale_of_patch.empty() ? 0 : scale_of_patch[i];
    }
    std::uint32_t side(std::uint32_t i) const {
        return side_of_patch.empty() ? 0 : side_of_patch[i];
    }
    std::uint32_t side_count() const;
};

/// How much of an input face ended up in which patch.
struct Fragment {
    std::uint32_t face;
    std::uint32_t patch;
    double area;  ///< m^2
};

/// A triangle of an input face and the front surface that it lies in. A face that is not planar may
/// lie in several.
struct FaceTriangle {
    std::uint32_t face;
    std::uint32_t surface;
    std::array<std::uint32_t, 3> corners;  ///< which of Face::vertices; counter-clockwise
};

/// Connected faces (over shared edges), as `info` lists them.
struct Part {
    std::vector<std::uint32_t> objects;  ///< names of the objects it touches
    std::uint32_t face_count = 0;
    bool closed = false;             ///< every edge shared by two faces of opposite direction
    bool holds_light = false;        ///< a solid around a lamp, which sees the backs of its faces
    bool doubled = false;            ///< holds faces of double-sided materials
    std::uint32_t back_patches = 0;  ///< backs that --backfaces gave it
};

/// What was found in the input, and what became of it.
struct InputFaults {
    std::uint32_t welded = 0;       ///< positions drawn to another within Mesh::weld
    std::uint32_t moved = 0;        ///< vertices moved onto an edge within twice that
    std::uint32_t degenerate = 0;   ///< faces without area: dropped
    std::uint32_t crossing = 0;     ///< faces that cross themselves: dropped
    std::uint32_t duplicate = 0;    ///< faces that repeat another: dropped
    std::uint32_t split = 0;        ///< faces that are not planar: in triangles
    std::uint32_t overlapping = 0;  ///< pairs of surfaces of which each covers the other: kept
    std::uint32_t inside_out = 0;   ///< rooms whose fronts look outwards: kept
};

struct Mesh {
    std::vector<glm::dvec3> vertices;  ///< world space, m; corners shared by neighbours are one
    std::vector<Patch> patches;
    std::vector<Shooter> shooters;  ///< of all patches, in order; empty: each shoots for itself
    std::vector<Surface> surfaces;
    std::vector<Material> materials;  ///< the scene's, reflectance limited, then one black absorber
    std::vector<Fragment> fragments;  ///< of fronts only, sorted by face, then patch
    std::vector<FaceTriangle> face_triangles;  ///< of fronts, by face; none of dropped faces
    std::vector<Part> parts;
    std::vector<std::string> bands;
    std::vector<std::string> objects;
    std::uint32_t face_count = 0;  ///< of the scene, dropped ones included
    std::uint32_t dropped_degenerate = 0, dropped_duplicate = 0;
    InputFaults input;
    double weld = 0;      ///< m; vertices closer than this are one
    bool closed = false;  ///< every part is closed: no proxel can escape
    std::vector<std::string> warnings;

    std::size_t shooter_count() const;
    double area(const Patch& patch) const;          ///< m^2
    glm::dvec3 normal(const Patch& patch) const;    ///< unit, towards the front
    glm::dvec3 centroid(const Patch& patch) const;  ///< of its area
};

enum class Backfaces { automatic, block, cull };

struct MeshSettings {
    double patch_size = 0;  ///< m; 0: from the scene's extent; infinity: a patch a face, uncut
    /// m; patches are cut into elements no longer than this, which then are Mesh::patches, and
    /// shoot as one (Mesh::shooters). 0: a patch is its own only element.
    double element_size = 0;
    std::uint32_t split_levels = 0;  ///< how often split_mesh() may split an element or a shooter
    Backfaces backfaces = Backfaces::automatic;
    double max_reflectance = 0.98;
    double weld = 0;  ///< m; vertices closer than this are one; 0: as precise as the scene is
};

/// More patches than build_mesh() makes.
inline constexpr double kMostMeshPatches = 1e8;  // some 20 GB

/// So many patches at least will build_mesh() make, since none is larger than its size squared;
/// where faces repeat others, which then are dropped, fewer.
double least_patches(const Scene& scene, const MeshSettings& settings);

/// Cuts a scene into patches: welds, drops degenerate and duplicate faces (with warnings that give
/// coordinates), finds surfaces, lays the grid, cuts along the edges of others that lie on them
/// (where a block stands on a floor, no patch lies partly under it; not with an infinite patch
/// size), adds the backs that `settings.backfaces` asks for.
/// Throws InputError where nothing is left.
Mesh build_mesh(const Scene& scene, const MeshSettings& settings);

/// What is to be split.
struct Splits {
    std::vector<bool> elements;       ///< by patch
    std::vector<bool> shooters = {};  ///< by shooter; empty: none
};

/// The mesh that build_mesh made of the scene, or this function of that, with elements and shooters
/// split in four: those that were split less than `settings.split_levels` times. A shooter's parts
/// are whole elements: along a side that holds an odd number of these it becomes as many parts as
/// the number's least factor, none where it holds one. Surfaces and their grids stay.
Mesh split_mesh(const Scene& scene, const MeshSettings& settings, const Mesh& mesh,
                const Splits& splits);

/// The patch size that `--patch-size` defaults to, m.
double default_patch_size(const Scene& scene);

}  // namespace hemirad
