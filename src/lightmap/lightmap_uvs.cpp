#include "lightmap/lightmap_uvs.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

namespace hemirad {
namespace {

constexpr std::uint32_t kNoChart = 0xffffffffu;

std::vector<std::uint32_t> charts_by_surface(const Mesh& mesh, const ChartLayout& layout) {
    std::vector<std::uint32_t> chart_of(mesh.surfaces.size(), kNoChart);
    for (std::uint32_t i = 0; i < layout.charts.size(); ++i) chart_of[layout.charts[i].surface] = i;
    return chart_of;
}

class UvFinder {
  public:
    UvFinder(const Scene& scene, const Mesh& mesh, const ChartLayout& layout)
        : scene_(scene), mesh_(mesh), layout_(layout), chart_of_(charts_by_surface(mesh, layout)) {}

    void add(const FaceTriangle& triangle, std::uint32_t surface,
             std::vector<UvTriangle>& found) const {
        if (chart_of_[surface] == kNoChart) return;
        const Chart& chart = layout_.charts[chart_of_[surface]];
        UvTriangle uvs{
            triangle.face, mesh_.surfaces[surface].is_back, chart.atlas, triangle.corners, {}};
        if (uvs.is_back) std::swap(uvs.corners[1], uvs.corners[2]);
        for (std::size_t i = 0; i < 3; ++i)
            uvs.uvs[i] = uv_of(chart, scene_.faces[triangle.face].vertices[uvs.corners[i]]);
        found.push_back(uvs);
    }

  private:
    /// Welding may have moved the surface off the position a little.
    glm::dvec2 uv_of(const Chart& chart, std::uint32_t position) const {
        const glm::dvec2 texel =
            atlas_from_world(chart, mesh_.surfaces[chart.surface], scene_.positions[position]);
        return glm::clamp(texel / glm::dvec2(layout_.width, layout_.height), 0.0, 1.0);
    }

    const Scene& scene_;
    const Mesh& mesh_;
    const ChartLayout& layout_;
    std::vector<std::uint32_t> chart_of_;
};

}  // namespace

std::vector<UvTriangle> lightmap_uvs(const Scene& scene, const Mesh& mesh,
                                     const ChartLayout& layout) {
    const UvFinder finder(scene, mesh, layout);
    const auto& triangles = mesh.face_triangles;
    std::vector<UvTriangle> found;
    for (std::size_t begin = 0, end = 0; begin < triangles.size(); begin = end) {
        while (end < triangles.size() && triangles[end].face == triangles[begin].face) ++end;
        for (std::size_t i = begin; i < end; ++i)
            finder.add(triangles[i], triangles[i].surface, found);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t back = mesh.surfaces[triangles[i].surface].reverse;
            if (back != kNoReverse) finder.add(triangles[i], back, found);
        }
    }
    return found;
}

}  // namespace hemirad
