#include "cli/formfactors_report.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli/memory.h"
#include "cli/sha256.h"
#include "cli/text.h"
#include "lightmap/atomic_file.h"

namespace hemirad {
namespace {

using Json = nlohmann::ordered_json;

std::string short_text(double value, int digits = 3) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, value);
    return text.data();
}

Json json(const Range& range) { return {{"min", range.least}, {"max", range.most}}; }

Json json(const std::optional<LawErrors>& errors) {
    if (!errors) return nullptr;
    return {{"reciprocity", errors->reciprocity}, {"closure", errors->closure}};
}

Json device_json(const FactorsOutcome& outcome) {
    const auto& array = outcome.pe_array;
    return {{"name", outcome.device.name},
            {"compute_units", outcome.device.compute_units},
            {"pe", std::to_string(array.width) + "x" + std::to_string(array.height)},
            {"lanes", array.lanes}};
}

/// Options that may be repeated are lists, those without a value true.
Json settings_json(const FormFactorsOptions& options) {
    Json settings = Json::object();
    for (const auto& [option, value] : deciding_options(options)) {
        auto name = option.substr(2);
        std::replace(name.begin(), name.end(), '-', '_');
        const bool is_name = option == "--from" || option.ends_with("-only");
        const auto number = Json::parse(value, nullptr, false);
        if (is_name)
            settings[name].push_back(value);
        else if (value.empty())
            settings[name] = true;
        else
            settings[name] = number.is_number() ? number : Json(value);
    }
    return settings;
}

Json outputs_json(const FormFactorsOptions& options) {
    Json outputs = Json::array();
    if (!options.output) return outputs;
    const bool is_readable = std::filesystem::is_regular_file(*options.output);
    outputs.push_back({{"file", options.output->string()},
                       {"sha256", is_readable ? Json(sha256(*options.output)) : Json(nullptr)}});
    return outputs;
}

Json enforce_json(const FactorsOutcome& outcome) {
    if (!outcome.before) return nullptr;
    return {{"before", json(outcome.before)}, {"after", json(outcome.after)}};
}

}  // namespace

Range row_sums(const FormFactors& factors) {
    Range range{std::numeric_limits<double>::infinity(), 0};
    for (const auto& row : factors.rows) {
        double sum = 0;
        for (const FormFactor& f : row) sum += f.value;
        range = {std::min(range.least, sum), std::max(range.most, sum)};
    }
    return range;
}

void print_summary(std::ostream& out, const FactorsOutcome& outcome) {
    const auto range = [](const Range& r) {
        return short_text(r.least, 6) + " to " + short_text(r.most, 6);
    };
    const auto errors = [](const LawErrors& e) {
        return "reciprocity " + short_text(e.reciprocity) + ", closure " + short_text(e.closure);
    };
    out << "factors      " << counted(outcome.rows, "row") << ", " << outcome.factors
        << " factors that are not 0, in " << duration_text(outcome.factor_seconds) << '\n'
        << "row sums     " << range(outcome.row_sums) << ", outside " << range(outcome.outside)
        << '\n';
    if (outcome.reciprocity)
        out << "reciprocity  A_i F_ij and A_j F_ji differ by at most "
            << short_text(*outcome.reciprocity) << " of the larger area\n";
    if (outcome.before)
        out << "enforced     errors before: " << errors(*outcome.before)
            << "; after: " << errors(*outcome.after) << '\n';
}

void write_report(const std::filesystem::path& path, const FormFactorsOptions& options,
                  const FactorsOutcome& outcome) {
    const Json report = {
        {"scene",
         {{"patches", outcome.patches},
          {"surfaces", outcome.surfaces},
          {"closed", outcome.closed}}},
        {"device", device_json(outcome)},
        {"settings", settings_json(options)},
        {"rows", outcome.rows},
        {"factors", outcome.factors},
        {"row_sums", json(outcome.row_sums)},
        {"outside", json(outcome.outside)},
        {"reciprocity", outcome.reciprocity ? Json(*outcome.reciprocity) : Json(nullptr)},
        {"enforce", enforce_json(outcome)},
        {"seconds",
         {{"total", outcome.total_seconds},
          {"factors", outcome.factor_seconds},
          {"enforce", outcome.enforce_seconds}}},
        {"peak_memory_bytes", peak_memory_bytes()},
        {"outputs", outputs_json(options)},
        {"warnings", outcome.warnings}};
    // Names in a scene may be in any encoding; JSON is UTF-8.
    const auto text = report.dump(2, ' ', false, Json::error_handler_t::replace);
    write_atomically(path, [&](std::ostream& out) { out << text << '\n'; });
}

}  // namespace hemirad
