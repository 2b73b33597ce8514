#include "lightmap/footprint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>

#include "lightmap/texel_areas.h"

namespace hemirad {
namespace {

/// Coverages this close to 0 or 1 are rounding of the corners' coordinates.
constexpr double kCoverageSlack = 1e-6;

/// A hidden patch gives way to any other.
constexpr double kHiddenWeight = 1e-9;

class FootprintBuilder {
  public:
    FootprintBuilder(const Rectangle& within, const std::vector<bool>& hidden) : hidden_(hidden) {
        footprints_.within = within;
        footprints_.texels.resize(std::size_t{within.width} * within.height);
    }

    void add_map(const PlaceMap& map) { footprints_.maps.push_back(map); }

    /// A patch, or a part of it, through the map that was added last.
    void add(std::uint32_t patch, const TexelPolygon& polygon, const Rectangle& within) {
        const double weight = hidden_[patch] ? kHiddenWeight : 1.0;
        find_texel_areas(polygon, within, areas_);
        for (const auto& [x, y, area] : areas_) {
            Footprint& texel = footprints_.at(x, y);
            texel.coverage += area;
            const bool has_centre = area < 1 && holds(polygon, {x + 0.5, y + 0.5});
            const auto weighted = static_cast<float>(weight * (has_centre ? 1 + area : area));
            if (weighted <= texel.largest) continue;
            texel.largest = weighted;
            texel.patch = patch;
            texel.map = static_cast<std::uint32_t>(footprints_.maps.size() - 1);
        }
    }

    Footprints take(std::uint32_t padding) {
        for (Footprint& texel : footprints_.texels) snap(texel);
        mark_shown();
        for (std::uint32_t i = 0; i < shown_.size(); ++i)
            if (shown_[i]) footprints_.texels[i].from = i;
        fill_gutters(padding);
        fill_hidden();
        return std::move(footprints_);
    }

  private:
    static void snap(Footprint& texel) {
        if (texel.coverage < kCoverageSlack)
            texel = {};
        else if (texel.coverage > 1.0 - kCoverageSlack)
            texel.coverage = 1.0;
    }

    /// Where all that there is is hidden, it shows itself.
    void mark_shown() {
        const auto& texels = footprints_.texels;
        shown_.resize(texels.size());
        for (std::size_t i = 0; i < texels.size(); ++i)
            shown_[i] = texels[i].patch != kNoPatch && !hidden_[texels[i].patch];
        if (std::ranges::find(shown_, true) != shown_.end()) return;
        for (std::size_t i = 0; i < texels.size(); ++i) shown_[i] = texels[i].patch != kNoPatch;
    }

    bool is_inner(std::int64_t x, std::int64_t y) const {
        const auto& [left, top, width, height] = footprints_.within;
        for (const int up : {-1, 0, 1})
            for (const int right : {-1, 0, 1}) {
                const std::int64_t nx = x + right, ny = y + up;
                if (nx < 0 || ny < 0 || nx >= width || ny >= height) continue;
                if (!shown_[static_cast<std::size_t>(ny * width + nx)]) return false;
            }
        return true;
    }

    /// Every shown texel at a rim offers itself to those about it; the nearest is taken, the first
    /// of equals.
    void fill_gutters(std::uint32_t padding) {
        const std::int64_t width = footprints_.within.width, height = footprints_.within.height;
        const std::int64_t reach = padding;
        std::vector<std::uint32_t> distances(footprints_.texels.size(),
                                             std::numeric_limits<std::uint32_t>::max());
        for (std::int64_t y = 0; y < height; ++y)
            for (std::int64_t x = 0; x < width; ++x) {
                const auto from = static_cast<std::size_t>(y * width + x);
                if (!shown_[from] || is_inner(x, y)) continue;
                for (std::int64_t ty = std::max<std::int64_t>(0, y - reach);
                     ty <= std::min(height - 1, y + reach); ++ty)
                    for (std::int64_t tx = std::max<std::int64_t>(0, x - reach);
                         tx <= std::min(width - 1, x + reach); ++tx) {
                        const auto distance =
                            static_cast<std::uint32_t>((tx - x) * (tx - x) + (ty - y) * (ty - y));
                        offer(from, static_cast<std::size_t>(ty * width + tx), distance, distances);
                    }
            }
    }

    void offer(std::size_t from, std::size_t to, std::uint32_t distance,
               std::vector<std::uint32_t>& distances) {
        if (shown_[to] || distance >= distances[to]) return;
        distances[to] = distance;
        footprints_.texels[to].patch = footprints_.texels[from].patch;
        footprints_.texels[to].map = footprints_.texels[from].map;
        footprints_.texels[to].from = static_cast<std::uint32_t>(from);
    }

    /// What is under a block from its rim on, in steps of a texel.
    void fill_hidden() {
        auto& texels = footprints_.texels;
        const std::size_t width = footprints_.within.width;
        const auto is_hidden = [&](std::size_t i) {
            return texels[i].patch != kNoPatch && hidden_[texels[i].patch] && !shown_[i];
        };
        std::vector<std::size_t> front;
        for (std::size_t i = 0; i < texels.size(); ++i)
            if (texels[i].patch != kNoPatch && !hidden_[texels[i].patch]) front.push_back(i);
        for (std::size_t next = 0; next < front.size(); ++next) {
            const std::size_t i = front[next];
            const std::size_t x = i % width;
            const auto spread = [&](std::size_t to) {
                if (!is_hidden(to)) return;
                texels[to].patch = texels[i].patch;
                texels[to].map = texels[i].map;
                texels[to].from = texels[i].from;
                front.push_back(to);
            };
            if (x > 0) spread(i - 1);
            if (x + 1 < width) spread(i + 1);
            if (i >= width) spread(i - width);
            if (i + width < texels.size()) spread(i + width);
        }
    }

    const std::vector<bool>& hidden_;
    Footprints footprints_;
    std::vector<bool> shown_;
    std::vector<TexelArea> areas_;
};

TexelPolygon polygon_of(const Mesh& mesh, const Patch& patch, auto&& texel_of) {
    TexelPolygon polygon;
    const std::size_t corner_count = patch.is_triangle() ? 3 : 4;
    for (std::size_t i = 0; i < corner_count; ++i)
        polygon.add(texel_of(mesh.vertices[patch.corners[i]]));
    return polygon;
}

PlaceMap map_of(const Chart& chart) {
    const glm::dvec2& texel = chart.texel_size;
    return {{-double(chart.x) * texel.x, double(chart.y + chart.height) * texel.y},
            {texel.x, 0.0},
            {0.0, -texel.y}};
}

/// The affine map that takes three points to three others: p = origin + x per_x + y per_y.
PlaceMap map_between(const std::array<glm::dvec2, 3>& from, const std::array<glm::dvec2, 3>& to) {
    const glm::dvec2 a = from[1] - from[0], b = from[2] - from[0];
    const glm::dvec2 p = to[1] - to[0], q = to[2] - to[0];
    const double determinant = a.x * b.y - a.y * b.x;
    PlaceMap map;
    map.per_x = (b.y * p - a.y * q) / determinant;
    map.per_y = (a.x * q - b.x * p) / determinant;
    map.origin = to[0] - from[0].x * map.per_x - from[0].y * map.per_y;
    return map;
}

bool has_area(const std::array<glm::dvec2, 3>& corners) {
    constexpr double kLeast = 1e-9;
    const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    return std::abs(a.x * b.y - a.y * b.x) > kLeast * (glm::dot(a, a) + glm::dot(b, b));
}

std::span<const Fragment> fragments_of(const Mesh& mesh, std::uint32_t face) {
    const auto found = std::ranges::equal_range(mesh.fragments, face, {}, &Fragment::face);
    return {found.begin(), found.end()};
}

void add_authored(const Mesh& mesh, const AuthoredTriangle& triangle, const Rectangle& within,
                  FootprintBuilder& builder) {
    if (!has_area(triangle.texels) || !has_area(triangle.at)) return;
    const FaceTriangle& of = mesh.face_triangles[triangle.face_triangle];
    const Surface& surface = mesh.surfaces[of.surface];
    builder.add_map(map_between(triangle.texels, triangle.at));
    const PlaceMap into_atlas = map_between(triangle.at, triangle.texels);
    for (const Fragment& fragment : fragments_of(mesh, of.face)) {
        const Patch& patch = mesh.patches[fragment.patch];
        if (patch.surface != of.surface) continue;
        const TexelPolygon whole = polygon_of(mesh, patch, [&](const glm::dvec3& point) {
            const glm::dvec3 offset = point - surface.origin;
            return glm::dvec2(glm::dot(offset, surface.u_axis), glm::dot(offset, surface.v_axis));
        });
        TexelPolygon part = clip_to_triangle(whole, triangle.at);
        for (std::size_t i = 0; i < part.count; ++i)
            part.corners[i] = into_atlas.place_of(part.corners[i]);
        if (part.count > 2) builder.add(fragment.patch, part, within);
    }
}

Footprints chart_footprints(const Mesh& mesh, const ChartLayout& layout, const Chart& chart,
                            const std::vector<bool>& hidden) {
    const Surface& surface = mesh.surfaces[chart.surface];
    const std::uint32_t padding = layout.padding;
    const Rectangle inner{chart.x, chart.y, chart.width, chart.height};
    FootprintBuilder builder({chart.x - padding, chart.y - padding, chart.width + 2 * padding,
                              chart.height + 2 * padding},
                             hidden);
    builder.add_map(map_of(chart));
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
        const std::uint32_t patch = surface.first_patch + i;
        builder.add(patch,
                    polygon_of(mesh, mesh.patches[patch],
                               [&](const glm::dvec3& point) {
                                   return atlas_from_world(chart, surface, point);
                               }),
                    inner);
    }
    return builder.take(padding);
}

Footprints authored_footprints(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
                               const std::vector<bool>& hidden) {
    const auto [width, height] = layout.atlases[atlas];
    const Rectangle whole{0, 0, width, height};
    FootprintBuilder builder(whole, hidden);
    for (const AuthoredTriangle& triangle : layout.authored)
        if (triangle.atlas == atlas) add_authored(mesh, triangle, whole, builder);
    return builder.take(layout.padding);
}

}  // namespace

void for_each_footprints(const Mesh& mesh, const ChartLayout& layout, std::uint32_t atlas,
                         const std::vector<bool>& hidden,
                         const std::function<void(const Footprints&)>& visit) {
    if (std::ranges::find(layout.authored, atlas, &AuthoredTriangle::atlas) !=
        layout.authored.end())
        visit(authored_footprints(mesh, layout, atlas, hidden));
    for (const Chart& chart : layout.charts)
        if (chart.atlas == atlas) visit(chart_footprints(mesh, layout, chart, hidden));
}

}  // namespace hemirad
