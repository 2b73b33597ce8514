#include "cli/sweep_csv.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "cli/text.h"
#include "errors.h"
#include "lightmap/atomic_file.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

constexpr std::size_t kSettings = 17;
constexpr std::size_t kFirstMeasured = kSettings;

const std::vector<std::string>& settings_columns() {
    static const std::vector<std::string> names{
        "scene",    "patches",    "patch_size", "device",     "compute_units", "array",
        "pe",       "lanes",      "tile",       "arrays",     "layout",        "broadcast",
        "evaluate", "accumulate", "distance",   "resolution", "shots"};
    return names;
}

const std::vector<std::string>& measured_columns() {
    static const std::vector<std::string> names{
        "visible_patches", "projected_patches", "stack_levels",    "stack_fill",
        "tile_patches",    "areas_visited",     "areas_per_patch", "useful_per_area",
        "bytes_broadcast", "wrong_per_million", "seconds_min",     "seconds_median"};
    return names;
}

const std::vector<std::string>& mp1_columns() {
    static const std::vector<std::string> names{"mp1_total",      "mp1_cull",         "mp1_set_up",
                                                "mp1_diffusion",  "mp1_inside_tests", "mp1_depth",
                                                "mp1_accumulate", "mp1_update",       "mp1_choose"};
    return names;
}

std::string joined(const std::vector<std::string>& fields) {
    std::string text;
    for (const auto& field : fields) text += (text.empty() ? "" : ",") + field;
    return text;
}

std::string header() {
    std::vector<std::string> names = settings_columns();
    names.insert(names.end(), measured_columns().begin(), measured_columns().end());
    for (const auto& kernel : launched_kernels(FormFactorMode::count))
        names.push_back("seconds_" + kernel);
    names.insert(names.end(), mp1_columns().begin(), mp1_columns().end());
    return joined(names);
}

std::vector<std::string> fields_of(const std::string& line) {
    std::vector<std::string> fields(1);
    for (const char c : line) {
        if (c == ',')
            fields.emplace_back();
        else
            fields.back() += c;
    }
    return fields;
}

std::string settings_of_line(const std::string& line) {
    auto fields = fields_of(line);
    fields.resize(std::min(fields.size(), kSettings));
    std::string text = fields.front();
    for (std::size_t i = 1; i < fields.size(); ++i) text += "," + fields[i];
    return text;
}

/// Names of scenes and devices may hold what separates the fields.
std::string as_field(const std::string& name) {
    std::string field = printable(name);
    std::replace_if(
        field.begin(), field.end(), [](char c) { return c == ',' || c == '"'; }, ' ');
    return field;
}

std::string sides(std::uint32_t width, std::uint32_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

std::string layout_name(mp1map::Layout layout) {
    return layout == mp1map::Layout::cyclic ? "cyclic" : "block";
}

std::string broadcast_name(mp1map::Broadcast broadcast) {
    switch (broadcast) {
        case mp1map::Broadcast::patch:
            return "patch";
        case mp1map::Broadcast::batch:
            return "batch";
        case mp1map::Broadcast::level:
            return "level";
    }
    return "";
}

std::string seconds_text(const std::map<std::string, double>& seconds, const std::string& kernel) {
    const auto found = seconds.find(kernel);
    return number_text(found == seconds.end() ? 0 : found->second);
}

std::string levels_text(const std::vector<double>& fill) {
    std::string text;
    for (const double level : fill) text += (text.empty() ? "" : ";") + number_text(level);
    return text;
}

std::vector<std::string> measured_fields(const SweepMeasurement& measured,
                                         const std::string& wrong_per_million) {
    const auto ratio = [](double a, double b) { return number_text(b > 0 ? a / b : 0); };
    const double bytes =
        measured.tile_patches * (sizeof(device::Projection) + sizeof(device::Rectangle));
    std::vector<std::string> fields{number_text(measured.visible),
                                    number_text(measured.projected),
                                    number_text(measured.stack_levels),
                                    levels_text(measured.stack_fill),
                                    number_text(measured.tile_patches),
                                    number_text(measured.areas),
                                    ratio(measured.areas, measured.projected),
                                    ratio(measured.useful, measured.areas),
                                    number_text(bytes),
                                    wrong_per_million,
                                    number_text(measured.seconds_min),
                                    number_text(measured.seconds_median)};
    for (const auto& kernel : launched_kernels(FormFactorMode::count))
        fields.push_back(seconds_text(measured.kernel_seconds, kernel));
    const auto& mp1 = measured.mp1;
    for (const double seconds : {mp1.total(), mp1.cull, mp1.set_up, mp1.diffusion, mp1.inside_tests,
                                 mp1.depth, mp1.accumulate, mp1.update, mp1.choose})
        fields.push_back(number_text(seconds));
    return fields;
}

/// Whole lines; what follows the last line's end is torn.
std::vector<std::string> whole_lines(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream content;
    content << in.rdbuf();
    std::vector<std::string> lines;
    for (std::string line; std::getline(content, line) && !content.eof();) lines.push_back(line);
    return lines;
}

bool is_number(const std::string& text) {
    char* end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0' && std::isfinite(number) && number >= 0;
}

/// One number, or one a stack level.
bool are_numbers(const std::string& field) {
    std::stringstream levels(field);
    bool any = false;
    for (std::string level; std::getline(levels, level, ';'); any = true)
        if (!is_number(level)) return false;
    return any;
}

void check_row(const std::string& line, const std::vector<std::string>& columns) {
    const auto fields = fields_of(line);
    if (fields.size() != columns.size()) throw std::logic_error("sweep: a row of another length");
    for (std::size_t i = kFirstMeasured; i < fields.size(); ++i) {
        if (columns[i] == "wrong_per_million" && fields[i].empty()) continue;
        if (!are_numbers(fields[i]))
            throw std::logic_error("sweep: " + columns[i] + " is \"" + fields[i] + "\"");
    }
}

}  // namespace

std::string settings_text(const SweepRow& row) {
    const auto& [point, units] = row.planned;
    const auto array = mp1map::fit_pe_array(row.device, point.pe_array);
    return joined({as_field(row.scene), std::to_string(row.patches), number_text(row.patch_size),
                   as_field(row.device.name), std::to_string(row.device.compute_units),
                   sides(point.mp1_width, point.mp1_height), sides(array.width, array.height),
                   std::to_string(array.lanes), sides(array.tile_width, array.tile_height),
                   std::to_string(array.array_count), layout_name(array.layout),
                   broadcast_name(array.broadcast),
                   point.variants.incremental ? "incremental" : "direct",
                   point.variants.xnet ? "xnet" : "histogram",
                   point.variants.constant_distance ? "constant" : "true",
                   std::to_string(point.resolution), std::to_string(row.shots)});
}

std::string title(const SweepRow& row) {
    const auto& point = row.planned.point;
    const auto array = mp1map::fit_pe_array(row.device, point.pe_array);
    std::string text = row.scene + ", " + sides(point.resolution, point.resolution) + ", " +
                       array.description() + ", " + counted(row.device.compute_units, "unit");
    if (point.mp1_width > array.width) text += ", of " + sides(point.mp1_width, point.mp1_height);
    if (array.layout == mp1map::Layout::block) text += ", block";
    if (array.broadcast != mp1map::Broadcast::batch) text += ", " + broadcast_name(array.broadcast);
    if (point.variants.incremental) text += ", incremental";
    if (point.variants.xnet) text += ", xnet";
    if (point.variants.constant_distance) text += ", constant distance";
    return text;
}

SweepCsv::SweepCsv(const std::filesystem::path& file) : file_(file) {
    check_writable(file);
    if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))
        throw OutputError(printable(file.string()) +
                          ": is not a regular file; a sweep has to be read again to go on");
    const auto lines = whole_lines(file);
    const std::size_t column_count = fields_of(header()).size();
    if (!lines.empty() && lines.front() != header())
        throw InputError(printable(file.string()) + ": is no sweep of this version; move it away");
    if (lines.empty() && std::filesystem::exists(file) && std::filesystem::file_size(file) > 0)
        throw InputError(printable(file.string()) + ": is no sweep; move it away");
    std::string kept = header() + "\n";
    for (std::size_t i = 1; i < lines.size(); ++i) {
        if (fields_of(lines[i]).size() != column_count) continue;
        kept += lines[i] + "\n";
        settings_.insert(settings_of_line(lines[i]));
    }
    write_atomically(file, [&](std::ostream& out) { out << kept; });
    out_.open(file, std::ios::binary | std::ios::app);
    if (!out_) throw OutputError(printable(file.string()) + ": cannot be written");
}

void SweepCsv::append(const std::string& settings, const SweepMeasurement& measured,
                      const std::string& wrong_per_million) {
    const std::string line =
        settings + "," + joined(measured_fields(measured, wrong_per_million)) + "\n";
    if (!(out_ << line).flush())
        throw OutputError(printable(file_.string()) + ": cannot be written");
    settings_.insert(settings);
}

void check_shape(const std::filesystem::path& file, std::size_t rows) {
    const auto lines = whole_lines(file);
    if (lines.size() != rows + 1) throw std::logic_error("sweep: rows are missing or twice there");
    const auto columns = fields_of(lines.front());
    std::set<std::string> settings;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        check_row(lines[i], columns);
        settings.insert(settings_of_line(lines[i]));
    }
    if (settings.size() != rows) throw std::logic_error("sweep: two rows of the same settings");
}

}  // namespace hemirad
