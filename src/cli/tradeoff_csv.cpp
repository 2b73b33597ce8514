#include "cli/tradeoff_csv.h"

#include <algorithm>
#include <ostream>

#include "cli/text.h"
#include "lightmap/atomic_file.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

// Samples and seconds are of one row of factors, or of one whole solve.
constexpr const char* kHeader =
    "kind,scene,method,runs_on,patch_size,patches,resolution,shooter_samples,plane_half_width,"
    "shooters,shots,samples,seconds,rms_error,largest_error,row_sum_error,faces_rms_error,pareto\n";

/// Names of scenes may hold what separates the fields.
std::string as_field(const std::string& name) {
    std::string field = printable(name);
    std::replace_if(
        field.begin(), field.end(), [](char c) { return c == ',' || c == '"'; }, ' ');
    return field;
}

/// Empty where a setting has no meaning.
std::string number_or_empty(double number) { return number > 0 ? number_text(number) : ""; }

}  // namespace

void TradeoffCsv::add(const TradeoffScene& scene, const FactorPoint& point, std::size_t shooters,
                      const FactorMeasurement& measured) {
    const auto& errors = measured.errors;
    rows_.push_back(
        {{"factors", as_field(scene.name), name_of(point.method), name_of(point.runs_on),
          number_text(scene.patch_size), std::to_string(scene.patches),
          number_or_empty(point.resolution), number_or_empty(point.shooter_samples),
          number_or_empty(point.plane_half_width), std::to_string(shooters), "",
          number_text(measured.samples), number_text(measured.seconds), number_text(errors.rms),
          number_text(errors.largest), number_text(errors.row_sum), ""},
         "factors",
         measured.seconds,
         errors.rms});
}

void TradeoffCsv::add(const TradeoffScene& scene, const SolvePoint& point,
                      const SolveMeasurement& measured) {
    const auto& errors = measured.errors;
    rows_.push_back({{"solve", as_field(scene.name), name_of(point.method), "device",
                      number_text(scene.patch_size), std::to_string(scene.patches),
                      std::to_string(point.resolution), std::to_string(point.shooter_samples), "",
                      "", std::to_string(measured.shots), number_text(measured.samples),
                      number_text(measured.seconds), number_text(errors.patches_rms),
                      number_text(errors.patches_largest), "", number_text(errors.faces_rms)},
                     "solve",
                     measured.seconds,
                     errors.faces_rms});
}

bool TradeoffCsv::is_on_front(const Row& row) const {
    return std::none_of(rows_.begin(), rows_.end(), [&](const Row& other) {
        return other.kind == row.kind && other.seconds <= row.seconds && other.error <= row.error &&
               (other.seconds < row.seconds || other.error < row.error);
    });
}

void TradeoffCsv::write(const std::filesystem::path& file) const {
    write_atomically(file, [&](std::ostream& out) {
        out << kHeader;
        for (const Row& row : rows_) {
            for (const auto& field : row.fields) out << field << ',';
            out << (is_on_front(row) ? 1 : 0) << '\n';
        }
    });
}

}  // namespace hemirad
