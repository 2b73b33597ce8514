#include "lightmap/patch_lookup.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

namespace hemirad {
namespace {

/// Of a length: what rounding may put a point beside a line that it lies on.
constexpr double kSlack = 1e-7;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// A wall's ends count as its own, so that walls which meet leave no gap.
bool crosses(const Wall& wall, const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 way = to - from, along = wall.to - wall.from;
    const double slack = kSlack * glm::dot(along, along), across = kSlack * glm::length(along);
    const double before = cross(along, from - wall.from), after = cross(along, to - wall.from);
    if ((before > 0) == (after > 0)) return false;
    const double part = before / (before - after);
    const double on_wall = glm::dot(along, from + part * way - wall.from);
    return across > 0 && on_wall >= -slack && on_wall <= glm::dot(along, along) + slack;
}

std::span<const std::pair<std::uint32_t, std::uint32_t>> equal_cells(
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& entries, std::uint32_t cell) {
    const auto found = std::ranges::equal_range(entries, cell, {},
                                                &std::pair<std::uint32_t, std::uint32_t>::first);
    return {found.begin(), found.end()};
}

}  // namespace

PatchLookup::PatchLookup(const Mesh& mesh, std::uint32_t surface)
    : mesh_(mesh), surface_(mesh.surfaces[surface]) {
    if (!surface_.scale_of_patch.empty())
        largest_scale_ = std::ranges::max(surface_.scale_of_patch);
    block_columns_ = ((surface_.columns - 1) >> largest_scale_) + 1;
    block_rows_ = ((surface_.rows - 1) >> largest_scale_) + 1;
    block_size_ = surface_.cell_size * double(1u << largest_scale_);
    for (std::uint32_t i = 0; i < surface_.patch_count; ++i) {
        patches_in_cells_.emplace_back(surface_.cell_of_patch[i], surface_.first_patch + i);
        centroids_.push_back(place_of(mesh.centroid(mesh.patches[surface_.first_patch + i])));
    }
    std::ranges::sort(patches_in_cells_);
    for (std::uint32_t wall = 0; wall < surface_.walls.size(); ++wall) add_wall(wall);
    std::ranges::sort(walls_in_blocks_);
}

PatchLookup::Range PatchLookup::blocks_about(const glm::dvec2& from, const glm::dvec2& to,
                                             double slack) const {
    const glm::dvec2 low = glm::floor(glm::min(from, to) / block_size_ - slack);
    const glm::dvec2 high = glm::floor(glm::max(from, to) / block_size_ + slack);
    const auto clamped = [](double block, std::uint32_t count) {
        return static_cast<std::int64_t>(std::clamp(block, 0.0, count - 1.0));
    };
    return {clamped(low.x, block_columns_), clamped(high.x, block_columns_),
            clamped(low.y, block_rows_), clamped(high.y, block_rows_)};
}

// Row by row, the blocks that the part of the wall in that row runs through.
void PatchLookup::add_wall(std::uint32_t index) {
    const Wall& wall = surface_.walls[index];
    const glm::dvec2 along = wall.to - wall.from;
    const Range all = blocks_about(wall.from, wall.to, kSlack);
    for (std::int64_t row = all.low_row; row <= all.high_row; ++row) {
        double enter = 0, leave = 1;
        if (std::abs(along.y) > kSlack * block_size_.y) {
            const double a = ((row - kSlack) * block_size_.y - wall.from.y) / along.y;
            const double b = ((row + 1 + kSlack) * block_size_.y - wall.from.y) / along.y;
            enter = std::clamp(std::min(a, b), 0.0, 1.0);
            leave = std::clamp(std::max(a, b), 0.0, 1.0);
        }
        const Range here =
            blocks_about(wall.from + enter * along, wall.from + leave * along, kSlack);
        for (std::int64_t column = here.low_column; column <= here.high_column; ++column)
            walls_in_blocks_.emplace_back(static_cast<std::uint32_t>(row * block_columns_ + column),
                                          index);
    }
}

void PatchLookup::find_in(std::uint32_t scale, std::int64_t column, std::int64_t row,
                          std::vector<std::uint32_t>& found) const {
    found.clear();
    if (column < 0 || row < 0) return;
    const std::int64_t first_column = column << scale, first_row = row << scale;
    const std::int64_t size = std::int64_t{1} << scale;
    if (first_column >= surface_.columns || first_row >= surface_.rows) return;
    for (std::int64_t r = first_row; r < std::min<std::int64_t>(first_row + size, surface_.rows);
         ++r) {
        const auto begin = std::ranges::lower_bound(
            patches_in_cells_,
            Entry{static_cast<std::uint32_t>(r * surface_.columns + first_column), 0});
        const auto end = static_cast<std::uint64_t>(
            r * surface_.columns + std::min<std::int64_t>(first_column + size, surface_.columns));
        for (auto entry = begin; entry != patches_in_cells_.end() && entry->first < end; ++entry)
            found.push_back(entry->second);
    }
    // Larger patches stand in the first of their cells.
    for (std::uint32_t larger = scale + 1; larger <= largest_scale_; ++larger) {
        const std::int64_t c = first_column >> larger << larger, r = first_row >> larger << larger;
        for (const auto& [cell, patch] :
             equal_cells(patches_in_cells_, static_cast<std::uint32_t>(r * surface_.columns + c)))
            if (surface_.scale(patch - surface_.first_patch) >= larger &&
                std::ranges::find(found, patch) == found.end())
                found.push_back(patch);
    }
}

std::uint32_t PatchLookup::at(const glm::dvec2& place) const {
    const glm::dvec2 cell = glm::floor(place / surface_.cell_size);
    std::vector<std::uint32_t> found;
    find_in(0, static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y), found);
    for (const std::uint32_t patch : found)
        if (holds(patch, place)) return patch;
    return kNoPatch;
}

const glm::dvec2& PatchLookup::centroid(std::uint32_t patch) const {
    return centroids_[patch - surface_.first_patch];
}

bool PatchLookup::is_open(const glm::dvec2& from, const glm::dvec2& to) const {
    if (surface_.walls.empty()) return true;
    const Range blocks = blocks_about(from, to, kSlack);
    for (std::int64_t row = blocks.low_row; row <= blocks.high_row; ++row)
        for (std::int64_t column = blocks.low_column; column <= blocks.high_column; ++column)
            for (const auto& [block, wall] : equal_cells(
                     walls_in_blocks_, static_cast<std::uint32_t>(row * block_columns_ + column)))
                if (crosses(surface_.walls[wall], from, to)) return false;
    return true;
}

bool PatchLookup::has_wall_near(std::uint32_t scale, const glm::dvec2& place) const {
    if (walls_in_blocks_.empty()) return false;
    const glm::dvec2 reach = 1.5 * surface_.cell_size * double(1u << scale);
    const Range blocks = blocks_about(place - reach, place + reach, 0.0);
    for (std::int64_t row = blocks.low_row; row <= blocks.high_row; ++row) {
        const auto first = static_cast<std::uint32_t>(row * block_columns_ + blocks.low_column);
        const auto last = static_cast<std::uint32_t>(row * block_columns_ + blocks.high_column);
        const auto found = std::ranges::lower_bound(walls_in_blocks_, Entry{first, 0});
        if (found != walls_in_blocks_.end() && found->first <= last) return true;
    }
    return false;
}

bool PatchLookup::holds(std::uint32_t index, const glm::dvec2& place) const {
    const Patch& patch = mesh_.patches[index];
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 a = place_of(mesh_.vertices[patch.corners[i]]);
        const glm::dvec2 edge = place_of(mesh_.vertices[patch.corners[(i + 1) % 4]]) - a;
        if (cross(edge, place - a) < -kSlack * glm::dot(edge, edge)) return false;
    }
    return true;
}

glm::dvec2 PatchLookup::place_of(const glm::dvec3& point) const {
    const glm::dvec3 offset = point - surface_.origin;
    return {glm::dot(offset, surface_.u_axis), glm::dot(offset, surface_.v_axis)};
}

}  // namespace hemirad
