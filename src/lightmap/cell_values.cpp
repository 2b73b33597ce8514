#include "lightmap/cell_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hemirad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

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

}  // namespace

CellValues::CellValues(const Surface& surface, std::span<const double> areas,
                       std::span<const double> values, std::uint32_t side) {
    for (std::uint32_t scale = 0; scale <= largest_scale(surface); ++scale) {
        const std::uint32_t columns = surface.columns >> scale, rows = surface.rows >> scale;
        std::vector<WeightedMean> means(std::size_t{columns} * rows);
        Grid grid{columns, rows, {}, std::vector<bool>(means.size())};
        for (std::uint32_t i = 0; i < surface.patch_count; ++i) {
            if (surface.scale(i) > scale || surface.side(i) != side) continue;
            const std::uint32_t cell = surface.cell_of_patch[i];
            const std::size_t at = std::size_t{(cell / surface.columns) >> scale} * columns +
                                   ((cell % surface.columns) >> scale);
            means[at].add(areas[i], values[i]);
            if (surface.scale(i) == scale) grid.covered[at] = true;
        }
        for (const WeightedMean& mean : means) grid.values.push_back(mean.value());
        grids_.push_back(std::move(grid));
    }
    for (auto scale = static_cast<std::uint32_t>(grids_.size() - 1); scale-- > 0;) refine(scale);
}

void CellValues::refine(std::uint32_t scale) {
    Grid& fine = grids_[scale];
    const Grid& coarse = grids_[scale + 1];
    for (std::uint32_t row = 0; row < fine.rows; ++row) {
        for (std::uint32_t column = 0; column < fine.columns; ++column) {
            if (!coarse.covered[std::size_t{row / 2} * coarse.columns + column / 2]) continue;
            const std::size_t at = std::size_t{row} * fine.columns + column;
            fine.values[at] = coarse.interpolate((glm::dvec2(column, row) + 0.5) / 2.0);
            fine.covered[at] = true;
        }
    }
}

double CellValues::Grid::interpolate(const glm::dvec2& position) const {
    const Neighbours across = neighbours_of(position.x, columns);
    const Neighbours up = neighbours_of(position.y, rows);
    WeightedMean mean;
    const auto add = [&](std::uint32_t column, std::uint32_t row, double weight) {
        const double value = values[std::size_t{row} * columns + column];
        if (!std::isnan(value)) mean.add(weight, value);
    };
    const double u = across.high_weight, v = up.high_weight;
    add(across.low, up.low, (1.0 - u) * (1.0 - v));
    add(across.high, up.low, u * (1.0 - v));
    add(across.low, up.high, (1.0 - u) * v);
    add(across.high, up.high, u * v);
    return mean.value();
}

double CellValues::at(const glm::dvec2& position, std::uint32_t fallback) const {
    const double value = grids_[0].interpolate(position);
    return std::isnan(value) ? grids_[0].values[fallback] : value;
}

double CellValues::at_scale(std::uint32_t scale, std::int64_t column, std::int64_t row) const {
    const Grid& grid = grids_[scale];
    if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return kNone;
    return grid.values[static_cast<std::size_t>(row * grid.columns + column)];
}

std::vector<CellValues> cell_values_by_side(const Surface& surface, std::span<const double> areas,
                                            std::span<const double> values) {
    std::vector<CellValues> by_side;
    for (std::uint32_t side = 0; side < surface.side_count(); ++side)
        by_side.emplace_back(surface, areas, values, side);
    return by_side;
}

}  // namespace hemirad
