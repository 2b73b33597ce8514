#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/tradeoff_factors.h"
#include "cli/tradeoff_plan.h"
#include "cli/tradeoff_solves.h"

namespace hemirad {

/// What rows have in common.
struct TradeoffScene {
    std::string name;
    double patch_size = 0;  ///< m
    std::size_t patches = 0;
};

/// A table of settings, what they cost and how far they are off.
class TradeoffCsv {
  public:
    void add(const TradeoffScene& scene, const FactorPoint& point, std::size_t shooters,
             const FactorMeasurement& measured);
    void add(const TradeoffScene& scene, const SolvePoint& point, const SolveMeasurement& measured);

    /// With a column that tells which rows no other of their kind beats in both time and error.
    /// Throws OutputError.
    void write(const std::filesystem::path& file) const;

  private:
    struct Row {
        std::vector<std::string> fields;
        std::string kind;
        double seconds, error;
    };
    bool is_on_front(const Row& row) const;

    std::vector<Row> rows_;
};

}  // namespace hemirad
