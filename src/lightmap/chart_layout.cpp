#include "lightmap/chart_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <string>

#include "errors.h"
#include "lightmap/authored_charts.h"
#include "lightmap/pack_rectangles.h"

namespace hemirad {
namespace {

/// Charts at the default texel size fill at most this much: a quarter of the largest atlas.
constexpr double kDefaultTexelLimit = 8192.0 * 8192.0;

/// Cell edges divide by texel sizes with rounding: 2.0 / 0.1 texels shall be 20, not 21.
constexpr double kWholeTexelSlack = 1e-6;

glm::dvec2 extent_of(const Surface& surface) {
    return surface.cell_size * glm::dvec2(surface.columns, surface.rows);
}

double area_of_chart(const Surface& surface) {
    const glm::dvec2 extent = extent_of(surface);
    return extent.x * extent.y;
}

double chart_area(const Mesh& mesh) {
    double sum = 0;
    for (const Surface& surface : mesh.surfaces)
        sum += surface.has_chart ? area_of_chart(surface) : 0.0;
    return sum;
}

std::string in_short(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

/// Surfaces that have a chart of their own: not where all of a front's faces lie elsewhere.
std::vector<bool> surfaces_with_chart(const Mesh& mesh) {
    std::vector<bool> with_chart;
    for (const Surface& surface : mesh.surfaces) with_chart.push_back(surface.has_chart);
    return with_chart;
}

std::vector<bool> surfaces_with_chart(const Mesh& mesh,
                                      const std::vector<AuthoredTriangle>& authored) {
    std::vector<bool> with_chart = surfaces_with_chart(mesh);
    std::vector<bool> needs_one(mesh.surfaces.size(), false);
    std::vector<bool> lies_elsewhere(mesh.face_triangles.size(), false);
    for (const AuthoredTriangle& triangle : authored) lies_elsewhere[triangle.face_triangle] = true;
    for (std::size_t i = 0; i < mesh.face_triangles.size(); ++i)
        if (!lies_elsewhere[i]) needs_one[mesh.face_triangles[i].surface] = true;
    for (std::size_t front = 0; front < mesh.surfaces.size(); ++front) {
        if (mesh.surfaces[front].is_back || needs_one[front]) continue;
        with_chart[front] = false;
        const std::uint32_t back = mesh.surfaces[front].reverse;
        if (back != kNoReverse) with_chart[back] = false;
    }
    return with_chart;
}

/// Generated charts and the atlases that they fill.
class Packer {
  public:
    Packer(const Mesh& mesh, const ChartSettings& settings, ChartLayout& layout)
        : mesh_(mesh),
          layout_(layout),
          side_(settings.atlas_size > 0 ? settings.atlas_size : kLargestAtlas) {}

    void add(std::uint32_t surface) {
        const glm::dvec2 extent = extent_of(mesh_.surfaces[surface]);
        const double width = whole_texels(extent.x), height = whole_texels(extent.y);
        const double room = 1.0 * side_ - 2.0 * layout_.padding;
        if (!(std::max(width, height) <= room)) refuse_chart(surface, {width, height}, room);
        Chart chart;
        chart.surface = surface;
        chart.width = static_cast<std::uint32_t>(width);
        chart.height = static_cast<std::uint32_t>(height);
        chart.texel_size = extent / glm::dvec2(width, height);
        layout_.charts.push_back(chart);
    }

    void pack() {
        std::vector<std::uint32_t> open(layout_.charts.size());
        double area = 0;
        for (std::uint32_t i = 0; i < open.size(); ++i) {
            open[i] = i;
            area += 1.0 * padded(i).width * padded(i).height;
        }
        if (area > kMostTexels) refuse_area(area);
        while (!open.empty()) open = fill_atlas(open);
    }

  private:
    double whole_texels(double length) const {
        return std::max(1.0, std::ceil(length / layout_.texel_size - kWholeTexelSlack));
    }

    [[noreturn]] void refuse_chart(std::uint32_t surface, const glm::dvec2& texels,
                                   double room) const {
        const std::uint32_t object = mesh_.surfaces[surface].object;
        const std::string name =
            object < mesh_.objects.size() ? "\"" + mesh_.objects[object] + "\"" : "a surface";
        const double advised =
            1.01 * layout_.texel_size * std::max(texels.x, texels.y) / std::max(room, 1.0);
        throw InputError("--texel-size " + in_short(layout_.texel_size) + ": the chart of " + name +
                         " takes " + in_short(texels.x) + " x " + in_short(texels.y) +
                         " texels, an atlas of " + std::to_string(side_) + " has room for " +
                         in_short(std::max(room, 0.0)) + " a side; try --texel-size " +
                         in_short(advised));
    }

    [[noreturn]] void refuse_area(double area) const {
        throw InputError("--texel-size " + in_short(layout_.texel_size) +
                         ": the lightmap would exceed " + std::to_string(kLargestAtlas) + " x " +
                         std::to_string(kLargestAtlas) + " texels; try --texel-size " +
                         in_short(1.1 * layout_.texel_size * std::sqrt(area / kMostTexels)));
    }

    Rectangle padded(std::uint32_t chart) const {
        return {0, 0, layout_.charts[chart].width + 2 * layout_.padding,
                layout_.charts[chart].height + 2 * layout_.padding};
    }

    /// Those that are left for further atlases.
    std::vector<std::uint32_t> fill_atlas(const std::vector<std::uint32_t>& open) {
        std::vector<Rectangle> rectangles;
        for (const std::uint32_t chart : open) rectangles.push_back(padded(chart));
        if (pack_in_one(rectangles)) {
            place(open, rectangles, std::vector<bool>(open.size(), true));
            return {};
        }
        const auto placed = pack_rectangles(rectangles, side_, side_);
        place(open, rectangles, placed);
        std::vector<std::uint32_t> left;
        for (std::size_t i = 0; i < open.size(); ++i)
            if (!placed[i]) left.push_back(open[i]);
        return left;
    }

    /// The narrowest of widths 2 % apart that needs no more height than width.
    bool pack_in_one(std::vector<Rectangle>& rectangles) const {
        double area = 0.0, side = 1.0;
        for (const Rectangle& r : rectangles) {
            area += 1.0 * r.width * r.height;
            side = std::max({side, 1.0 * r.width, 1.0 * r.height});
        }
        side = std::max(side, std::ceil(std::sqrt(area)));
        while (side <= side_ &&
               pack_rectangles(rectangles, static_cast<std::uint32_t>(side)) > side)
            side = side < side_ ? std::min(std::ceil(side * 1.02), 1.0 * side_) : side + 1;
        return side <= side_;
    }

    void place(const std::vector<std::uint32_t>& charts, const std::vector<Rectangle>& rectangles,
               const std::vector<bool>& placed) {
        Atlas atlas;
        for (std::size_t i = 0; i < charts.size(); ++i) {
            if (!placed[i]) continue;
            const Rectangle& r = rectangles[i];
            Chart& chart = layout_.charts[charts[i]];
            chart.atlas = static_cast<std::uint32_t>(layout_.atlases.size());
            chart.x = r.x + layout_.padding;
            chart.y = r.y + layout_.padding;
            atlas.width = std::max(atlas.width, r.x + r.width);
            atlas.height = std::max(atlas.height, r.y + r.height);
        }
        layout_.atlases.push_back(atlas);
    }

    const Mesh& mesh_;
    ChartLayout& layout_;
    std::uint32_t side_;
};

ChartLayout empty_layout(const Mesh& mesh, const ChartSettings& settings) {
    if (!(settings.texel_size >= 0.0) || std::isinf(settings.texel_size)) {
        throw InputError("--texel-size " + in_short(settings.texel_size) + ": must be positive");
    }
    ChartLayout layout;
    layout.padding = settings.padding;
    layout.flip_v = settings.flip_v;
    layout.texel_size = settings.texel_size > 0.0 ? settings.texel_size : default_texel_size(mesh);
    return layout;
}

void generate_charts(const Mesh& mesh, const std::vector<bool>& with_chart,
                     const ChartSettings& settings, ChartLayout& layout) {
    Packer packer(mesh, settings, layout);
    for (std::uint32_t i = 0; i < mesh.surfaces.size(); ++i)
        if (with_chart[i]) packer.add(i);
    packer.pack();
    if (layout.atlases.empty()) layout.atlases.emplace_back();
}

}  // namespace

// By area: many small faces of one object are not to refine the walls, but furniture throughout is.
double default_texel_size(const Mesh& mesh) {
    std::vector<std::pair<double, double>> edges;  // and the area of their charts
    for (const Surface& surface : mesh.surfaces)
        if (surface.has_chart)
            edges.emplace_back(std::min(surface.cell_size.x, surface.cell_size.y),
                               area_of_chart(surface));
    if (edges.empty()) return 1.0;
    std::ranges::sort(edges);
    const double area = chart_area(mesh);
    double sum = 0;
    const auto rank = std::ranges::find_if(
        edges, [&](const auto& edge) { return (sum += edge.second) >= area / 20; });
    const double edge = rank == edges.end() ? edges.back().first : rank->first;
    return std::max(edge / 2, std::sqrt(area / kDefaultTexelLimit));
}

ChartLayout lay_out_charts(const Mesh& mesh, const ChartSettings& settings) {
    ChartLayout layout = empty_layout(mesh, settings);
    generate_charts(mesh, surfaces_with_chart(mesh), settings, layout);
    return layout;
}

ChartLayout lay_out_charts(const Scene& scene, const Mesh& mesh, const ChartSettings& settings) {
    ChartLayout layout = empty_layout(mesh, settings);
    place_authored(scene, mesh, settings, layout);
    generate_charts(mesh, surfaces_with_chart(mesh, layout.authored), settings, layout);
    return layout;
}

glm::dvec2 atlas_from_world(const Chart& chart, const Surface& surface, const glm::dvec3& point) {
    const glm::dvec3 offset = point - surface.origin;
    const double s = glm::dot(offset, surface.u_axis), t = glm::dot(offset, surface.v_axis);
    return {chart.x + s / chart.texel_size.x, chart.y + chart.height - t / chart.texel_size.y};
}

}  // namespace hemirad
