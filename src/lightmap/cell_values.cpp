#include "lightmap/cell_values.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace hemirad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Cells a side of a block, where the grid has as many.
constexpr std::uint32_t kBlockBits = 3;

/// A weighted mean that is exact where all values are equal, because it sums differences.
class WeightedMean {
  public:
    void add(double weight, double value) {
        if (weight <= 0.0) return;
        if (weight_ == 0.0) pivot_ = value;
        weight_ += weight;
        moment_ += weight * (value - pivot_);
    }
    double value() const { return weight_ == 0.0 ? kNone : pivot_ + moment_ / weight_; }

  private:
    double pivot_ = 0.0, weight_ = 0.0, moment_ = 0.0;
};

/// The two cells whose centres enclose a position along one axis, in cells.
struct Neighbours {
    std::uint32_t low, high;
    double high_weight;
};

Neighbours neighbours_of(double position, std::uint32_t count) {
    const double clamped = std::clamp(position - 0.5, 0.0, count - 1.0);
    const auto low = static_cast<std::uint32_t>(clamped);
    return {low, std::min(low + 1, count - 1), clamped - low};
}

std::uint32_t largest_scale(const Surface& surface) {
    return surface.scale_of_patch.empty() ? 0 : *std::ranges::max_element(surface.scale_of_patch);
}

/// Of the scale: those that the patch covers, or the one that it lies in.
void for_each_cell(const Surface& surface, std::uint32_t patch, std::uint32_t scale,
                   const auto& visit) {
    const std::uint32_t cell = surface.cell_of_patch[patch];
    const std::uint32_t column = (cell % surface.columns) >> scale;
    const std::uint32_t row = (cell / surface.columns) >> scale;
    const std::uint32_t size = 1u << (std::max(surface.scale(patch), scale) - scale);
    for (std::uint32_t y = 0; y < size; ++y)
        for (std::uint32_t x = 0; x < size; ++x) visit(column + x, row + y);
}

std::uint32_t bits_of_block(std::uint32_t count) {
    return std::min(kBlockBits, static_cast<std::uint32_t>(std::bit_width(count - 1)));
}

}  // namespace

CellValues::Grid::Grid(std::uint32_t column_count, std::uint32_t row_count)
    : columns(column_count),
      rows(row_count),
      column_bits_(bits_of_block(columns)),
      row_bits_(bits_of_block(rows)),
      blocks_(block_of(columns - 1, rows - 1) + 1, 0) {}

std::size_t CellValues::Grid::block_of(std::uint32_t column, std::uint32_t row) const {
    const std::uint32_t across = ((columns - 1) >> column_bits_) + 1;
    return std::size_t{row >> row_bits_} * across + (column >> column_bits_);
}

void CellValues::Grid::hold(std::uint32_t column, std::uint32_t row) {
    std::uint32_t& block = blocks_[block_of(column, row)];
    if (block == 0) block = ++held_blocks_;
}

std::size_t CellValues::Grid::held_count() const {
    return std::size_t{held_blocks_} << (column_bits_ + row_bits_);
}

std::size_t CellValues::Grid::index_of(std::uint32_t column, std::uint32_t row) const {
    const std::size_t block = blocks_[block_of(column, row)] - 1;
    const std::uint32_t x = column & ((1u << column_bits_) - 1), y = row & ((1u << row_bits_) - 1);
    return (((block << row_bits_) + y) << column_bits_) + x;
}

double CellValues::Grid::value(std::uint32_t column, std::uint32_t row) const {
    return blocks_[block_of(column, row)] == 0 ? kNone : values[index_of(column, row)];
}

double CellValues::Grid::interpolate(const glm::dvec2& position) const {
    const Neighbours across = neighbours_of(position.x, columns);
    const Neighbours up = neighbours_of(position.y, rows);
    WeightedMean mean;
    const auto add = [&](std::uint32_t column, std::uint32_t row, double weight) {
        const double here = value(column, row);
        if (!std::isnan(here)) mean.add(weight, here);
    };
    const double u = across.high_weight, v = up.high_weight;
    add(across.low, up.low, (1.0 - u) * (1.0 - v));
    add(across.high, up.low, u * (1.0 - v));
    add(across.low, up.high, (1.0 - u) * v);
    add(across.high, up.high, u * v);
    return mean.value();
}

CellValues::CellValues(const Surface& surface, std::span<const double> areas,
                       std::span<const double> values, std::span<const std::uint32_t> patches) {
    for (std::uint32_t scale = 0; scale <= largest_scale(surface); ++scale) {
        Grid grid(surface.columns >> scale, surface.rows >> scale);
        for (const std::uint32_t i : patches)
            for_each_cell(surface, i, scale, std::bind_front(&Grid::hold, &grid));
        std::vector<WeightedMean> means(grid.held_count());
        for (const std::uint32_t i : patches)
            if (surface.scale(i) <= scale)
                for_each_cell(surface, i, scale, [&](std::uint32_t column, std::uint32_t row) {
                    means[grid.index_of(column, row)].add(areas[i], values[i]);
                });
        grid.values.reserve(means.size());
        for (const WeightedMean& mean : means) grid.values.push_back(mean.value());
        grids_.push_back(std::move(grid));
    }
    for (auto scale = static_cast<std::uint32_t>(grids_.size() - 1); scale-- > 0;)
        refine(surface, patches, scale);
}

void CellValues::refine(const Surface& surface, std::span<const std::uint32_t> patches,
                        std::uint32_t scale) {
    Grid& fine = grids_[scale];
    for (const std::uint32_t i : patches)
        if (surface.scale(i) > scale)
            for_each_cell(surface, i, scale, [&](std::uint32_t column, std::uint32_t row) {
                fine.values[fine.index_of(column, row)] =
                    grids_[scale + 1].interpolate((glm::dvec2(column, row) + 0.5) / 2.0);
            });
}

double CellValues::at(const glm::dvec2& position, std::uint32_t fallback) const {
    const Grid& grid = grids_[0];
    const double value = grid.interpolate(position);
    return std::isnan(value) ? grid.value(fallback % grid.columns, fallback / grid.columns) : value;
}

double CellValues::at_scale(std::uint32_t scale, std::int64_t column, std::int64_t row) const {
    const Grid& grid = grids_[scale];
    if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return kNone;
    return grid.value(static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row));
}

std::vector<CellValues> cell_values_by_side(const Surface& surface, std::span<const double> areas,
                                            std::span<const double> values) {
    std::vector<std::vector<std::uint32_t>> patches(surface.side_count());
    for (std::uint32_t i = 0; i < surface.patch_count; ++i) patches[surface.side(i)].push_back(i);
    std::vector<CellValues> by_side;
    for (const auto& of_side : patches) by_side.emplace_back(surface, areas, values, of_side);
    return by_side;
}

}  // namespace hemirad
