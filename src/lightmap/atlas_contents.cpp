#include "lightmap/atlas_contents.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <tuple>

#include "lightmap/lightmap_uvs.h"
#include "scene/disjoint_sets.h"

namespace hemirad {
namespace {

double area_in_atlas(const UvTriangle& triangle, const Atlas& atlas) {
    const glm::dvec2 size(atlas.width, atlas.height);
    const glm::dvec2 a = size * (triangle.uvs[1] - triangle.uvs[0]);
    const glm::dvec2 b = size * (triangle.uvs[2] - triangle.uvs[0]);
    return std::abs(a.x * b.y - a.y * b.x) / 2;
}

double area_in_world(const Scene& scene, const UvTriangle& triangle) {
    const Face& face = scene.faces[triangle.face];
    const auto at = [&](std::size_t i) {
        return scene.positions[face.vertices[triangle.corners[i]]];
    };
    return glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
}

/// Whose triangle has a corner where.
using Corner = std::tuple<std::uint32_t, double, double, std::uint32_t>;

std::vector<Corner> authored_corners(const Scene& scene, const Mesh& mesh,
                                     const ChartLayout& layout) {
    std::vector<Corner> corners;
    for (std::uint32_t i = 0; i < layout.authored.size(); ++i) {
        const auto& face_triangle = mesh.face_triangles[layout.authored[i].face_triangle];
        for (const glm::dvec2& texel : layout.authored[i].texels)
            corners.emplace_back(scene.faces[face_triangle.face].object, texel.x, texel.y, i);
    }
    std::ranges::sort(corners);
    return corners;
}

/// Of one object, which lies in one atlas: where it has two triangles with a corner in one place,
/// they are of one chart.
void count_authored(const Scene& scene, const Mesh& mesh, const ChartLayout& layout,
                    std::vector<AtlasContents>& atlases) {
    meshing::DisjointSets charts(layout.authored.size());
    const auto corners = authored_corners(scene, mesh, layout);
    const auto place = [](const Corner& c) {
        return std::tie(std::get<0>(c), std::get<1>(c), std::get<2>(c));
    };
    for (std::size_t i = 1; i < corners.size(); ++i)
        if (place(corners[i - 1]) == place(corners[i]))
            charts.join(std::get<3>(corners[i - 1]), std::get<3>(corners[i]));
    for (std::uint32_t i = 0; i < layout.authored.size(); ++i)
        if (charts.find(i) == i) ++atlases[layout.authored[i].atlas].chart_count;
}

}  // namespace

std::vector<AtlasContents> atlas_contents(const Scene& scene, const Mesh& mesh,
                                          const ChartLayout& layout) {
    std::vector<AtlasContents> atlases;
    for (const auto& [width, height] : layout.atlases) atlases.push_back({width, height});
    std::vector<std::set<std::uint32_t>> objects(atlases.size());
    std::vector<double> areas(atlases.size());
    for (const UvTriangle& triangle : lightmap_uvs(scene, mesh, layout)) {
        atlases[triangle.atlas].filled += area_in_atlas(triangle, layout.atlases[triangle.atlas]);
        areas[triangle.atlas] += area_in_world(scene, triangle);
        objects[triangle.atlas].insert(scene.faces[triangle.face].object);
    }
    for (const Chart& chart : layout.charts) ++atlases[chart.atlas].chart_count;
    count_authored(scene, mesh, layout, atlases);
    for (std::size_t i = 0; i < atlases.size(); ++i) {
        if (atlases[i].filled > 0) atlases[i].texel_size = std::sqrt(areas[i] / atlases[i].filled);
        atlases[i].objects.assign(objects[i].begin(), objects[i].end());
    }
    return atlases;
}

}  // namespace hemirad
