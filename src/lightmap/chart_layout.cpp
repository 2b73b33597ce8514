#include "lightmap/chart_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <string>

#include "errors.h"
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

double chart_area(const Mesh& mesh) {
    double sum = 0;
    for (const Surface& surface : mesh.surfaces) {
        const glm::dvec2 extent = extent_of(surface);
        sum += surface.has_chart ? extent.x * extent.y : 0.0;
    }
    return sum;
}

std::string in_short(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

[[noreturn]] void refuse_atlas(double texel_size, double advised) {
    throw InputError("--texel-size " + in_short(texel_size) + ": the lightmap would exceed " +
                     std::to_string(kLargestAtlas) + " texels a side; try --texel-size " +
                     in_short(advised));
}

double whole_texels(double length, double texel_size) {
    return std::max(1.0, std::ceil(length / texel_size - kWholeTexelSlack));
}

Chart chart_of(const Surface& surface, std::uint32_t index, const ChartLayout& layout) {
    const glm::dvec2 extent = extent_of(surface);
    const double width = whole_texels(extent.x, layout.texel_size);
    const double height = whole_texels(extent.y, layout.texel_size);
    const double room = double{kLargestAtlas} - 2.0 * layout.padding;
    const double longest = std::max(width, height);
    if (!(longest <= room)) {
        refuse_atlas(layout.texel_size, 1.01 * layout.texel_size * longest / std::max(room, 1.0));
    }
    Chart chart;
    chart.surface = index;
    chart.width = static_cast<std::uint32_t>(width);
    chart.height = static_cast<std::uint32_t>(height);
    chart.texel_size = extent / glm::dvec2(width, height);
    return chart;
}

std::vector<Rectangle> padded(const ChartLayout& layout) {
    std::vector<Rectangle> rectangles;
    rectangles.reserve(layout.charts.size());
    for (const Chart& chart : layout.charts) {
        rectangles.push_back(
            {0, 0, chart.width + 2 * layout.padding, chart.height + 2 * layout.padding});
    }
    return rectangles;
}

/// Throws InputError where `side` is too long for an atlas that holds `area` texels.
void require_side(double side, double area, double texel_size) {
    if (side <= kLargestAtlas) return;
    refuse_atlas(texel_size, 1.1 * texel_size * std::max(1.0, std::sqrt(area) / kLargestAtlas));
}

/// The narrowest of widths 2 % apart that needs no more height than width.
void pack(ChartLayout& layout) {
    std::vector<Rectangle> rectangles = padded(layout);
    double area = 0.0, side = 1.0;
    for (const Rectangle& r : rectangles) {
        area += 1.0 * r.width * r.height;
        side = std::max({side, 1.0 * r.width, 1.0 * r.height});
    }
    side = std::max(side, std::ceil(std::sqrt(area)));
    require_side(side, area, layout.texel_size);
    while (pack_rectangles(rectangles, static_cast<std::uint32_t>(side)) > side) {
        side = std::ceil(side * 1.02);
        require_side(side, area, layout.texel_size);
    }
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        layout.charts[i].x = rectangles[i].x + layout.padding;
        layout.charts[i].y = rectangles[i].y + layout.padding;
        layout.width = std::max(layout.width, rectangles[i].x + rectangles[i].width);
        layout.height = std::max(layout.height, rectangles[i].y + rectangles[i].height);
    }
}

}  // namespace

double default_texel_size(const Mesh& mesh) {
    std::vector<double> edges;
    for (const Surface& surface : mesh.surfaces) {
        if (surface.has_chart) edges.push_back(std::min(surface.cell_size.x, surface.cell_size.y));
    }
    if (edges.empty()) return 1.0;
    const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
    std::nth_element(edges.begin(), middle, edges.end());
    return std::max(*middle / 2.0, std::sqrt(chart_area(mesh) / kDefaultTexelLimit));
}

ChartLayout lay_out_charts(const Mesh& mesh, const ChartSettings& settings) {
    if (!(settings.texel_size >= 0.0) || std::isinf(settings.texel_size)) {
        throw InputError("--texel-size " + in_short(settings.texel_size) + ": must be positive");
    }
    ChartLayout layout;
    layout.padding = settings.padding;
    layout.texel_size = settings.texel_size > 0.0 ? settings.texel_size : default_texel_size(mesh);
    for (std::uint32_t i = 0; i < mesh.surfaces.size(); ++i) {
        if (mesh.surfaces[i].has_chart) {
            layout.charts.push_back(chart_of(mesh.surfaces[i], i, layout));
        }
    }
    pack(layout);
    return layout;
}

glm::dvec2 atlas_from_world(const Chart& chart, const Surface& surface, const glm::dvec3& point) {
    const glm::dvec3 offset = point - surface.origin;
    const double s = glm::dot(offset, surface.u_axis), t = glm::dot(offset, surface.v_axis);
    return {chart.x + s / chart.texel_size.x, chart.y + chart.height - t / chart.texel_size.y};
}

}  // namespace hemirad
