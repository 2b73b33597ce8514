#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "cli/formfactors_options.h"
#include "formfactor/form_factors.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"

namespace hemirad {

struct Range {
    double least = 0, most = 0;
};

/// How far factors are from the two laws that --enforce restores.
struct LawErrors {
    double reciprocity, closure;
};

/// What the factors came to, for the summary and the report.
struct FactorsOutcome {
    std::size_t patches = 0, surfaces = 0, rows = 0, factors = 0;  ///< factors that are not 0
    bool closed = false;
    Range row_sums, outside;
    std::optional<double> reciprocity;       ///< where there is a row for every column
    std::optional<LawErrors> before, after;  ///< --enforce
    double factor_seconds = 0, enforce_seconds = 0, total_seconds = 0;
    mp1map::DeviceSummary device;
    mp1map::PeArray pe_array;
    std::vector<std::string> warnings;
};

Range row_sums(const FormFactors& factors);

void print_summary(std::ostream& out, const FactorsOutcome& outcome);

/// --report: the outcome as JSON. Throws OutputError.
void write_report(const std::filesystem::path& path, const FormFactorsOptions& options,
                  const FactorsOutcome& outcome);

}  // namespace hemirad
