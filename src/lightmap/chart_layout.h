#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "scene/mesh.h"
#include "scene/scene.h"

namespace hemirad {

/// Longest side of an atlas: what current GPUs take as a texture.
inline constexpr std::uint32_t kLargestAtlas = 16384;

/// Of all atlases of generated charts together, and of all of authored ones: some 4 GB a float a
/// band and coverage.
inline constexpr double kMostTexels = double{kLargestAtlas} * kLargestAtlas;

/// Between charts there is twice this: room for bilinear filtering, and in images halved once or,
/// where charts lie well, twice.
inline constexpr std::uint32_t kDefaultPadding = 4;

/// Where charts come from.
enum class ChartSource {
    authored,   ///< the scene's own UVs, for faces that have some; the others' are generated
    generated,  ///< one for each surface
};

struct ChartSettings {
    double texel_size = 0;                    ///< m; 0: default_texel_size()
    std::uint32_t padding = kDefaultPadding;  ///< gutter around every chart, texels
    /// Longest side of an atlas, texels; an atlas of authored charts is a square of just this side.
    /// 0: kLargestAtlas, and authored charts get what the texel size asks for.
    std::uint32_t atlas_size = 0;
    bool flip_v = false;  ///< V runs up, in the scene's UVs and in lightmap_uvs()
    ChartSource source = ChartSource::authored;
};

/// A surface's place in an atlas, gutter not included. The chart shows the surface as seen from
/// its front: s to the right, t upwards, the top row being the largest t.
struct Chart {
    std::uint32_t surface = 0;
    std::uint32_t atlas = 0;
    std::uint32_t x = 0, y = 0;           ///< top left texel
    std::uint32_t width = 1, height = 1;  ///< texels
    glm::dvec2 texel_size{1.0};  ///< m; at most the layout's, so that whole texels fill the grid
};

/// Where the scene's own UVs put a triangle.
struct AuthoredTriangle {
    std::uint32_t face_triangle;  ///< of Mesh::face_triangles
    std::uint32_t atlas;
    std::array<glm::dvec2, 3> texels;  ///< of its corners, from the atlas's top left corner
    std::array<glm::dvec2, 3> at;      ///< of its corners on their surface: s, t, m
};

struct Atlas {
    std::uint32_t width = 0, height = 0;  ///< texels
};

struct ChartLayout {
    double texel_size = 0;  ///< m, as asked for
    std::uint32_t padding = 0;
    bool flip_v = false;
    std::vector<Atlas> atlases;              ///< first those of authored charts; at least one
    std::vector<Chart> charts;               ///< generated ones, in the order of their surfaces
    std::vector<AuthoredTriangle> authored;  ///< in the order of Mesh::face_triangles
    std::vector<std::string> warnings;       ///< one line each, for people
    std::vector<std::string> moved;          ///< the same, of objects that are not in their atlas
};

/// Half of the shorter cell edge that a twentieth of the charts' area is below, but not so small
/// that the charts alone would fill an atlas of 8192 x 8192.
double default_texel_size(const Mesh& mesh);

/// A chart for each surface that has one, packed into an atlas as square as possible, or into
/// several where one is not enough. The same mesh always gives the same layout. Throws InputError
/// where the texel size is not positive, a chart is larger than an atlas, or the atlases would hold
/// more texels than one of kLargestAtlas a side.
ChartLayout lay_out_charts(const Mesh& mesh, const ChartSettings& settings = {});

/// The same, but faces with UVs of their own, unless the settings ask for generated charts, lie
/// where these say: in the first atlas, or, where they would share texels with an earlier object,
/// in the next that is free. Backs of such faces have no chart. Throws InputError where UVs are
/// outside [0, 1], an object's overlap, or too many atlases would be needed.
ChartLayout lay_out_charts(const Scene& scene, const Mesh& mesh, const ChartSettings& settings);

/// Where a point of the surface lies in the atlas, in texels from its top left corner; the centre
/// of texel (x, y) is (x + 0.5, y + 0.5).
glm::dvec2 atlas_from_world(const Chart& chart, const Surface& surface, const glm::dvec3& point);

}  // namespace hemirad
