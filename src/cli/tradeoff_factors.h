#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "cli/tradeoff_plan.h"
#include "mp1map/device.h"
#include "reference/polygon.h"
#include "scene/mesh.h"

namespace hemirad {

/// Rows of factors against the truth; absolute.
struct FactorErrors {
    double rms = 0;  ///< over the patches that truth or method sees
    double largest = 0;
    double row_sum = 0;  ///< mean of |sum of a row + what truly leaves the scene - 1|
};

struct FactorMeasurement {
    double samples = 0;  ///< a row
    double seconds = 0;  ///< a row, the median
    FactorErrors errors;
};

/// Factors from some patches of a mesh, by one method after another.
class FactorRows {
  public:
    /// Keeps a reference to the mesh. Finds the truth for `shooters` fronts, evenly spread over the
    /// mesh, to within `truth_error`. `go_on` is asked now and then; once it says no, it always
    /// does.
    FactorRows(const Mesh& mesh, std::uint32_t shooters, double truth_error,
               const mp1map::Device& device, std::function<bool()> go_on);

    /// Nothing where it was stopped, or the truth was.
    std::optional<FactorMeasurement> measure(const FactorPoint& point) const;
    std::size_t row_count() const { return shooters_.size(); }

  private:
    const Mesh& mesh_;
    const mp1map::Device& device_;
    std::function<bool()> go_on_;
    std::vector<reference::Polygon> polygons_;
    std::vector<std::uint32_t> shooters_;
    std::vector<std::vector<double>> truth_;  ///< [row][patch]
    std::vector<double> outside_;             ///< [row]
};

}  // namespace hemirad
