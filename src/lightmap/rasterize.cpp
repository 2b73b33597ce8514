#include "lightmap/rasterize.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "lightmap/cell_values.h"

namespace hemirad {
namespace {

/// Coverages this close to 0 or 1 are rounding of the corners' coordinates.
constexpr double kCoverageSlack = 1e-6;

constexpr std::uint32_t kNoCell = std::numeric_limits<std::uint32_t>::max();

/// A convex polygon. A quad that four edges cut has at most eight corners; twice that is room for
/// one that rounding has left slightly concave.
struct Polygon {
    std::array<glm::dvec2, 16> corners;
    std::size_t count = 0;

    void add(const glm::dvec2& corner) {
        assert(count < corners.size());
        corners[count++] = corner;
    }
    std::span<const glm::dvec2> used() const { return {corners.data(), count}; }
};

double area_of(const Polygon& polygon) {
    double twice = 0.0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2 a = polygon.corners[i] - polygon.corners[0];
        const glm::dvec2 b = polygon.corners[(i + 1) % polygon.count] - polygon.corners[0];
        twice += a.x * b.y - b.x * a.y;
    }
    return std::abs(twice) / 2.0;
}

/// Sutherland and Hodgman (1974): the part where sign * (p[axis] - bound) >= 0.
Polygon clip(const Polygon& polygon, int axis, double bound, double sign) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& from = polygon.corners[i];
        const glm::dvec2& to = polygon.corners[(i + 1) % polygon.count];
        const double from_distance = sign * (from[axis] - bound);
        const double to_distance = sign * (to[axis] - bound);
        if (from_distance >= 0.0) kept.add(from);
        if (from_distance * to_distance < 0.0) {
            kept.add(from + (to - from) * (from_distance / (from_distance - to_distance)));
        }
    }
    return kept;
}

Polygon clip_to_slab(const Polygon& polygon, int axis, double low) {
    return clip(clip(polygon, axis, low, 1.0), axis, low + 1.0, -1.0);
}

Polygon in_atlas(const Mesh& mesh, const Chart& chart, const Patch& patch) {
    Polygon polygon;
    const std::size_t corner_count = patch.is_triangle() ? 3 : 4;
    for (std::size_t i = 0; i < corner_count; ++i) {
        polygon.add(
            atlas_from_world(chart, mesh.surfaces[chart.surface], mesh.vertices[patch.corners[i]]));
    }
    return polygon;
}

struct Span {
    std::uint32_t first, last;  ///< texels first ... last - 1
};

Span texels_of(const Polygon& polygon, int axis, std::uint32_t start, std::uint32_t size) {
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const glm::dvec2& corner : polygon.used()) {
        low = std::min(low, corner[axis]);
        high = std::max(high, corner[axis]);
    }
    const double from = start, to = from + size;
    return {static_cast<std::uint32_t>(std::clamp(std::floor(low), from, to)),
            static_cast<std::uint32_t>(std::clamp(std::ceil(high), from, to))};
}

/// One texel of a chart: what part of it the surface fills, and the cell and the side of the patch
/// that fills the most.
struct Footprint {
    double coverage = 0.0, largest = 0.0;
    std::uint32_t cell = kNoCell, side = 0;

    void add(double area, std::uint32_t from_cell, std::uint32_t from_side) {
        coverage += area;
        if (area > largest) {
            largest = area;
            cell = from_cell;
            side = from_side;
        }
    }
};

/// The texels of a chart, row by row.
struct ChartFootprint {
    const Chart& chart;
    std::vector<Footprint> texels;
    std::vector<double> patch_areas;  ///< in texels

    Footprint& at(std::uint32_t x, std::uint32_t y) {
        return texels[std::size_t{y - chart.y} * chart.width + (x - chart.x)];
    }
};

void add_patch(ChartFootprint& footprint, const Polygon& polygon, std::uint32_t cell,
               std::uint32_t side) {
    const Chart& chart = footprint.chart;
    const Span rows = texels_of(polygon, 1, chart.y, chart.height);
    for (std::uint32_t y = rows.first; y < rows.last; ++y) {
        const Polygon strip = clip_to_slab(polygon, 1, y);
        if (strip.count < 3) continue;
        const Span columns = texels_of(strip, 0, chart.x, chart.width);
        for (std::uint32_t x = columns.first; x < columns.last; ++x) {
            footprint.at(x, y).add(area_of(clip_to_slab(strip, 0, x)), cell, side);
        }
    }
    footprint.patch_areas.push_back(area_of(polygon));
}

ChartFootprint footprint_of(const Mesh& mesh, const Chart& chart) {
    const Surface& surface = mesh.surfaces[chart.surface];
    ChartFootprint footprint{chart, {}, {}};
    footprint.texels.resize(std::size_t{chart.width} * chart.height);
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const Patch& patch = mesh.patches[surface.first_patch + i];
        add_patch(footprint, in_atlas(mesh, chart, patch), surface.cell_of_patch[i],
                  surface.side(i));
    }
    return footprint;
}

float snapped(double coverage) {
    if (coverage < kCoverageSlack) return 0.0f;
    if (coverage > 1.0 - kCoverageSlack) return 1.0f;
    return static_cast<float>(coverage);
}

void write_coverage(Lightmap& lightmap, ChartFootprint& footprint) {
    const Chart& chart = footprint.chart;
    for (std::uint32_t y = chart.y; y < chart.y + chart.height; ++y) {
        for (std::uint32_t x = chart.x; x < chart.x + chart.width; ++x) {
            lightmap.coverage[std::size_t{y} * lightmap.width + x] =
                snapped(footprint.at(x, y).coverage);
        }
    }
}

void write_band(Lightmap& lightmap, std::size_t band, ChartFootprint& footprint,
                const Surface& surface, std::span<const double> patch_values) {
    const Chart& chart = footprint.chart;
    const auto cells_by_side =
        cell_values_by_side(surface, footprint.patch_areas,
                            patch_values.subspan(surface.first_patch, surface.patch_count));
    const glm::dvec2 cells_a_texel = chart.texel_size / surface.cell_size;
    for (std::uint32_t y = chart.y; y < chart.y + chart.height; ++y) {
        for (std::uint32_t x = chart.x; x < chart.x + chart.width; ++x) {
            const std::size_t texel = std::size_t{y} * lightmap.width + x;
            if (lightmap.coverage[texel] == 0.0f) continue;
            const glm::dvec2 centre(x - chart.x + 0.5, chart.y + chart.height - y - 0.5);
            const Footprint& from = footprint.at(x, y);
            const CellValues& cells = cells_by_side[from.side];
            lightmap.values[band][texel] =
                static_cast<float>(cells.at(centre * cells_a_texel, from.cell));
        }
    }
}

struct Offset {
    int x, y;
};

/// The square of texels around one, nearest first.
std::vector<Offset> offsets_within(int radius) {
    std::vector<Offset> offsets;
    for (int y = -radius; y <= radius; ++y) {
        for (int x = -radius; x <= radius; ++x) offsets.push_back({x, y});
    }
    std::stable_sort(offsets.begin(), offsets.end(), [](const Offset& a, const Offset& b) {
        return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
    });
    return offsets;
}

bool contains(const Chart& chart, std::int64_t x, std::int64_t y) {
    return x >= chart.x && x < std::int64_t{chart.x} + chart.width && y >= chart.y &&
           y < std::int64_t{chart.y} + chart.height;
}

void fill_texel(Lightmap& lightmap, const Chart& chart, std::uint32_t x, std::uint32_t y,
                const std::vector<Offset>& offsets) {
    for (const Offset& offset : offsets) {
        const std::int64_t from_x = std::int64_t{x} + offset.x, from_y = std::int64_t{y} + offset.y;
        if (!contains(chart, from_x, from_y)) continue;
        const auto from = static_cast<std::size_t>(from_y * lightmap.width + from_x);
        if (lightmap.coverage[from] == 0.0f) continue;
        for (auto& band : lightmap.values) band[std::size_t{y} * lightmap.width + x] = band[from];
        return;
    }
}

void fill_gutter(Lightmap& lightmap, const Chart& chart, std::uint32_t padding,
                 const std::vector<Offset>& offsets) {
    for (std::uint32_t y = chart.y - padding; y < chart.y + chart.height + padding; ++y) {
        for (std::uint32_t x = chart.x - padding; x < chart.x + chart.width + padding; ++x) {
            if (lightmap.coverage[std::size_t{y} * lightmap.width + x] > 0.0f) continue;
            fill_texel(lightmap, chart, x, y, offsets);
        }
    }
}

Lightmap empty_lightmap(const ChartLayout& layout, const std::vector<std::string>& bands) {
    Lightmap lightmap{layout.width, layout.height, bands, {}, {}};
    lightmap.values.assign(bands.size(), std::vector<float>(lightmap.texel_count()));
    lightmap.coverage.resize(lightmap.texel_count());
    return lightmap;
}

}  // namespace

Lightmap rasterize(const Mesh& mesh, const Solution& solution, const ChartLayout& layout,
                   Quantity quantity) {
    const auto& patch_values =
        quantity == Quantity::irradiance ? solution.irradiance : solution.radiosity;
    const auto offsets = offsets_within(static_cast<int>(std::max(2u, layout.padding)));
    Lightmap lightmap = empty_lightmap(layout, solution.bands);
    for (const Chart& chart : layout.charts) {
        ChartFootprint footprint = footprint_of(mesh, chart);
        write_coverage(lightmap, footprint);
        for (std::size_t band = 0; band < lightmap.bands.size(); ++band) {
            write_band(lightmap, band, footprint, mesh.surfaces[chart.surface], patch_values[band]);
        }
        fill_gutter(lightmap, chart, layout.padding, offsets);
    }
    return lightmap;
}

}  // namespace hemirad
