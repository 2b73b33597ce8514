#include "lightmap/lightmap_uvs.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace hemirad {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

std::vector<std::uint32_t> charts_by_surface(const Mesh& mesh, const ChartLayout& layout) {
    std::vector<std::uint32_t> chart_of(mesh.surfaces.size(), kNone);
    for (std::uint32_t i = 0; i < layout.charts.size(); ++i) chart_of[layout.charts[i].surface] = i;
    return chart_of;
}

std::vector<std::uint32_t> authored_by_triangle(const Mesh& mesh, const ChartLayout& layout) {
    std::vector<std::uint32_t> authored(mesh.face_triangles.size(), kNone);
    for (std::uint32_t i = 0; i < layout.authored.size(); ++i)
        authored[layout.authored[i].face_triangle] = i;
    return authored;
}

class UvFinder {
  public:
    UvFinder(const Scene& scene, const Mesh& mesh, const ChartLayout& layout)
        : scene_(scene),
          mesh_(mesh),
          layout_(layout),
          chart_of_(charts_by_surface(mesh, layout)),
          authored_(authored_by_triangle(mesh, layout)) {}

    void add_front(std::uint32_t index, std::vector<UvTriangle>& found) const {
        const FaceTriangle& triangle = mesh_.face_triangles[index];
        if (authored_[index] == kNone) return add_from_chart(triangle, triangle.surface, found);
        const AuthoredTriangle& from = layout_.authored[authored_[index]];
        UvTriangle uvs{triangle.face, false, from.atlas, triangle.corners, {}};
        for (std::size_t i = 0; i < 3; ++i) uvs.uvs[i] = uv_of(from.texels[i], from.atlas);
        found.push_back(uvs);
    }

    void add_back(std::uint32_t index, std::vector<UvTriangle>& found) const {
        const FaceTriangle& triangle = mesh_.face_triangles[index];
        const std::uint32_t back = mesh_.surfaces[triangle.surface].reverse;
        if (back != kNoReverse && authored_[index] == kNone) add_from_chart(triangle, back, found);
    }

  private:
    void add_from_chart(const FaceTriangle& triangle, std::uint32_t surface,
                        std::vector<UvTriangle>& found) const {
        if (chart_of_[surface] == kNone) return;
        const Chart& chart = layout_.charts[chart_of_[surface]];
        UvTriangle uvs{
            triangle.face, mesh_.surfaces[surface].is_back, chart.atlas, triangle.corners, {}};
        if (uvs.is_back) std::swap(uvs.corners[1], uvs.corners[2]);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t position = scene_.faces[triangle.face].vertices[uvs.corners[i]];
            uvs.uvs[i] =
                uv_of(atlas_from_world(chart, mesh_.surfaces[surface], scene_.positions[position]),
                      chart.atlas);
        }
        found.push_back(uvs);
    }

    /// Welding may have moved the surface off the position a little, hence the clamp.
    glm::dvec2 uv_of(const glm::dvec2& texel, std::uint32_t atlas) const {
        const auto [width, height] = layout_.atlases[atlas];
        const glm::dvec2 uv = glm::clamp(texel / glm::dvec2(width, height), 0.0, 1.0);
        return layout_.flip_v ? glm::dvec2(uv.x, 1 - uv.y) : uv;
    }

    const Scene& scene_;
    const Mesh& mesh_;
    const ChartLayout& layout_;
    std::vector<std::uint32_t> chart_of_;  ///< by surface
    std::vector<std::uint32_t> authored_;  ///< by Mesh::face_triangles
};

}  // namespace

std::vector<UvTriangle> lightmap_uvs(const Scene& scene, const Mesh& mesh,
                                     const ChartLayout& layout) {
    const UvFinder finder(scene, mesh, layout);
    const auto& triangles = mesh.face_triangles;
    std::vector<UvTriangle> found;
    for (std::uint32_t begin = 0, end = 0; begin < triangles.size(); begin = end) {
        while (end < triangles.size() && triangles[end].face == triangles[begin].face) ++end;
        for (std::uint32_t i = begin; i < end; ++i) finder.add_front(i, found);
        for (std::uint32_t i = begin; i < end; ++i) finder.add_back(i, found);
    }
    return found;
}

}  // namespace hemirad
