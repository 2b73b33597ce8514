#include "lightmap/gather_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <utility>

#include "lightmap/texel_points.h"

namespace hemirad {
namespace {

constexpr std::uint32_t kCoarsest = 16;  ///< texels along a cell's side

/// Patches tell features that gathering steps over, but err themselves.
constexpr double kGuideSlack = 3;

/// Texels of two triangles' maps are neighbours if the maps agree to so much of a texel.
constexpr double kSameMap = 0.05;

/// Where a texel lies between two columns or rows, which may be one.
double part_between(std::uint32_t low, std::uint32_t high, std::uint32_t at) {
    return high > low ? double(at - low) / double(high - low) : 0.0;
}

/// The plastic number's multiples spread evenly, see aim_hemisphere.cl.
std::uint32_t turn_of(std::uint32_t x, std::uint32_t y) {
    return (x + 1) * 3242174889u + y * 2447445414u;
}

template <class Value>
double between(const Value& value, const std::array<std::uint32_t, 2>& columns,
               const std::array<std::uint32_t, 2>& rows, std::uint32_t x, std::uint32_t y) {
    const double right = part_between(columns[0], columns[1], x);
    const double down = part_between(rows[0], rows[1], y);
    const auto along = [&](std::uint32_t row) {
        const double first = value(columns[0], row);
        return first + right * (value(columns[1], row) - first);
    };
    const double upper = along(rows[0]);
    return upper + down * (along(rows[1]) - upper);
}

/// Bilinear in the quarter of a cell that holds the texel.
template <class Cell, class Value>
double in_quarter(const Cell& cell, const Value& value, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t column = cell.middle_column(), row = cell.middle_row();
    const auto side = [](std::uint32_t low, std::uint32_t middle, std::uint32_t high,
                         std::uint32_t at) {
        return at <= middle ? std::array{low, middle} : std::array{middle, high};
    };
    return between(value, side(cell.left, column, cell.right, x),
                   side(cell.top, row, cell.bottom, y), x, y);
}

}  // namespace

GatherCells::GatherCells(const Mesh& mesh, const LightBlend& blend, const Lightmap& guide,
                         const GatherTolerance& tolerance, Footprints footprints)
    : mesh_(mesh),
      blend_(blend),
      guide_(guide),
      tolerance_(tolerance),
      footprints_(std::move(footprints)),
      states_(footprints_.texels.size(), State::nothing),
      values_(guide.values.size(), std::vector<float>(footprints_.texels.size())),
      beyond_(footprints_.texels.size(), kNoPatch) {
    for (std::uint32_t i = 0; i < states_.size(); ++i) shown_count_ += is_shown(i);
    want_gutter();
    if (tolerance.error > 0)
        lay_cells();
    else
        for (std::uint32_t i = 0; i < states_.size(); ++i) want(i);
}

std::uint32_t GatherCells::in_atlas(std::uint32_t texel) const {
    const auto& within = footprints_.within;
    return (within.y + texel / within.width) * guide_.width + within.x + texel % within.width;
}

glm::dvec2 GatherCells::place_of(std::uint32_t texel, std::uint32_t map) const {
    const auto& within = footprints_.within;
    return footprints_.maps[map].place_of(
        {within.x + texel % within.width + 0.5, within.y + texel / within.width + 0.5});
}

glm::dvec2 GatherCells::place_of(std::uint32_t texel) const {
    return place_of(texel, footprints_.texels[texel].map);
}

double GatherCells::texel_length(std::uint32_t map) const {
    return std::min(glm::length(footprints_.maps[map].per_x),
                    glm::length(footprints_.maps[map].per_y));
}

SurfacePoint GatherCells::point_of(std::uint32_t texel) const {
    const Footprint& from = footprints_.texels[texel];
    glm::dvec2 place = place_of(texel);
    std::uint32_t patch = from.patch;
    if (beyond_[texel] != kNoPatch) {
        const Surface& own = mesh_.surfaces[mesh_.patches[patch].surface];
        const glm::dvec3 point = own.origin + place.x * own.u_axis + place.y * own.v_axis;
        patch = beyond_[texel];
        const Surface& there = mesh_.surfaces[mesh_.patches[patch].surface];
        place = {glm::dot(point - there.origin, there.u_axis),
                 glm::dot(point - there.origin, there.v_axis)};
    }
    SurfacePoint point = point_on_patch(mesh_, patch, place, texel_length(from.map));
    const auto& within = footprints_.within;
    point.turn = turn_of(within.x + texel % within.width, within.y + texel / within.width);
    return point;
}

void GatherCells::lay_cells() {
    const std::uint32_t width = footprints_.within.width, height = footprints_.within.height;
    Cell all{width, height, 0, 0};
    for (std::uint32_t i = 0; i < states_.size(); ++i)
        if (is_shown(i))
            all = {std::min(all.left, i % width), std::min(all.top, i / width),
                   std::max(all.right, i % width), std::max(all.bottom, i / width)};
    if (shown_count_ == 0) return;
    for (std::uint32_t y = all.top; y == all.top || y < all.bottom; y += kCoarsest)
        for (std::uint32_t x = all.left; x == all.left || x < all.right; x += kCoarsest)
            cells_.push_back(
                {x, y, std::min(x + kCoarsest, all.right), std::min(y + kCoarsest, all.bottom)});
}

void GatherCells::want(std::uint32_t texel) {
    if (!is_shown(texel) && beyond_[texel] == kNoPatch) return;
    if (states_[texel] == State::wanted || states_[texel] == State::gathered) return;
    interpolated_count_ -= states_[texel] == State::interpolated;
    states_[texel] = State::wanted;
    wanted_.push_back(texel);
}

void GatherCells::want_nodes(const Cell& cell) {
    for (const std::uint32_t y : {cell.top, cell.middle_row(), cell.bottom})
        for (const std::uint32_t x : {cell.left, cell.middle_column(), cell.right}) want(at(x, y));
}

// Bilinear filtering at the chart's outline reads the first texels of the gutter.
void GatherCells::want_gutter() {
    const std::uint32_t width = footprints_.within.width;
    const auto apart = [](std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; };
    for (std::uint32_t i = 0; i < states_.size(); ++i) {
        const Footprint& texel = footprints_.texels[i];
        if (texel.from == kNoTexel || texel.from == i || texel.coverage > 0) continue;
        if (apart(i % width, texel.from % width) > 1 || apart(i / width, texel.from / width) > 1)
            continue;
        beyond_[i] = blend_.beyond(texel.patch, place_of(i));
        want(i);
    }
}

std::vector<SurfacePoint> GatherCells::wanted() {
    for (const Cell& cell : cells_) want_nodes(cell);
    std::vector<SurfacePoint> points;
    for (const std::uint32_t texel : wanted_) points.push_back(point_of(texel));
    return points;
}

bool GatherCells::take(const std::vector<std::vector<double>>& irradiance, std::size_t first) {
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
        states_[wanted_[i]] = State::gathered;
        gathered_count_ += is_shown(wanted_[i]);
        for (std::size_t band = 0; band < values_.size(); ++band)
            values_[band][wanted_[i]] = static_cast<float>(irradiance[band][first + i]);
    }
    wanted_.clear();
    const std::vector<Cell> cells = std::exchange(cells_, {});
    for (const Cell& cell : cells) settle(cell);
    return !cells_.empty();
}

void GatherCells::settle(const Cell& cell) {
    if (cell.is_whole() || !has_light(cell)) return;
    if (is_uniform(cell) && is_open(cell) && is_flat(cell))
        interpolate(cell);
    else
        split(cell);
}

// A side of one texel is not split further.
void GatherCells::split(const Cell& cell) {
    const auto parts = [](std::uint32_t low, std::uint32_t middle, std::uint32_t high) {
        std::vector<std::array<std::uint32_t, 2>> result;
        if (middle > low) result.push_back({low, middle});
        result.push_back({middle, high});
        return result;
    };
    for (const auto& [top, bottom] : parts(cell.top, cell.middle_row(), cell.bottom))
        for (const auto& [left, right] : parts(cell.left, cell.middle_column(), cell.right))
            cells_.push_back({left, top, right, bottom});
}

template <class Visit>
bool GatherCells::all_of(const Cell& cell, const Visit& visit) const {
    for (std::uint32_t y = cell.top; y <= cell.bottom; ++y)
        for (std::uint32_t x = cell.left; x <= cell.right; ++x)
            if (!visit(x, y)) return false;
    return true;
}

bool GatherCells::has_light(const Cell& cell) const {
    return !all_of(cell, [&](std::uint32_t x, std::uint32_t y) { return !is_shown(at(x, y)); });
}

// Of one surface, of one side of what stands on it, and by one map.
bool GatherCells::is_uniform(const Cell& cell) const {
    const Footprint& first = footprints_.texels[at(cell.left, cell.top)];
    if (!is_shown(at(cell.left, cell.top))) return false;
    const std::uint32_t index = mesh_.patches[first.patch].surface;
    const Surface& surface = mesh_.surfaces[index];
    const auto side = [&](std::uint32_t patch) {
        return surface.side(patch - surface.first_patch);
    };
    const double slack = kSameMap * texel_length(first.map);
    return all_of(cell, [&](std::uint32_t x, std::uint32_t y) {
        const std::uint32_t texel = at(x, y);
        const Footprint& own = footprints_.texels[texel];
        if (!is_shown(texel) || mesh_.patches[own.patch].surface != index) return false;
        if (side(own.patch) != side(first.patch)) return false;
        return own.map == first.map ||
               glm::distance(place_of(texel), place_of(texel, first.map)) < slack;
    });
}

bool GatherCells::is_open(const Cell& cell) const {
    const Footprint& first = footprints_.texels[at(cell.left, cell.top)];
    const std::uint32_t surface = mesh_.patches[first.patch].surface;
    const std::array corners{place_of(at(cell.left, cell.top)), place_of(at(cell.right, cell.top)),
                             place_of(at(cell.right, cell.bottom)),
                             place_of(at(cell.left, cell.bottom))};
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = i + 1; j < corners.size(); ++j)
            if (!blend_.is_open(surface, corners[i], corners[j])) return false;
    return true;
}

bool GatherCells::is_flat(const Cell& cell) const {
    for (std::size_t band = 0; band < values_.size(); ++band)
        if (!is_flat(cell, band)) return false;
    return true;
}

bool GatherCells::is_flat(const Cell& cell, std::size_t band) const {
    const auto gathered = [&](std::uint32_t x, std::uint32_t y) -> double {
        return values_[band][at(x, y)];
    };
    const auto known = [&](std::uint32_t x, std::uint32_t y) -> double {
        return guide_.values[band][in_atlas(at(x, y))];
    };
    const std::array columns{cell.left, cell.right}, rows{cell.top, cell.bottom};
    double mean = 0;
    for (const std::uint32_t y : rows)
        for (const std::uint32_t x : columns) mean += std::abs(gathered(x, y)) / 4;
    const double most = tolerance_.error * std::max(mean, tolerance_.least[band]);
    for (const std::uint32_t y : {cell.top, cell.middle_row(), cell.bottom})
        for (const std::uint32_t x : {cell.left, cell.middle_column(), cell.right})
            if (std::abs(gathered(x, y) - between(gathered, columns, rows, x, y)) > most)
                return false;
    return all_of(cell, [&](std::uint32_t x, std::uint32_t y) {
        return std::abs(known(x, y) - in_quarter(cell, known, x, y)) <= kGuideSlack * most;
    });
}

void GatherCells::interpolate(const Cell& cell) {
    all_of(cell, [&](std::uint32_t x, std::uint32_t y) {
        State& state = states_[at(x, y)];
        if (state == State::wanted || state == State::gathered) return true;
        interpolated_count_ += state == State::nothing;
        state = State::interpolated;
        for (auto& values : values_)
            values[at(x, y)] = static_cast<float>(in_quarter(
                cell,
                [&](std::uint32_t column, std::uint32_t row) -> double {
                    return values[at(column, row)];
                },
                x, y));
        return true;
    });
}

void GatherCells::write(std::vector<std::vector<float>>& irradiance,
                        std::vector<std::uint32_t>& patch_of_texel) const {
    for (std::uint32_t i = 0; i < states_.size(); ++i) {
        const Footprint& texel = footprints_.texels[i];
        if (texel.from == kNoTexel) continue;
        const std::uint32_t source = states_[i] == State::nothing ? texel.from : i;
        patch_of_texel[in_atlas(i)] = texel.patch;
        for (std::size_t band = 0; band < values_.size(); ++band)
            irradiance[band][in_atlas(i)] = values_[band][source];
    }
}

}  // namespace hemirad
