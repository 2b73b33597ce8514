#include "cli/report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/memory.h"
#include "cli/sha256.h"
#include "lightmap/atomic_file.h"
#include "lightmap/part_names.h"

namespace hemirad {
namespace {

using Json = nlohmann::ordered_json;

Json input_json(const InputFaults& input) {
    return {{"welded", input.welded},           {"moved", input.moved},
            {"degenerate", input.degenerate},   {"crossing", input.crossing},
            {"duplicate", input.duplicate},     {"split", input.split},
            {"overlapping", input.overlapping}, {"inside_out", input.inside_out}};
}

Json scene_json(const Mesh& mesh) {
    return {{"patches", mesh.shooter_count()},
            {"elements", mesh.patches.size()},
            {"bands", mesh.bands},
            {"closed", mesh.closed},
            {"weld", mesh.weld},
            {"input", input_json(mesh.input)}};
}

Json device_json(const Outcome& outcome) {
    const auto& array = outcome.pe_array;
    const auto shape = [](std::uint32_t width, std::uint32_t height) {
        return std::to_string(width) + "x" + std::to_string(height);
    };
    return {{"name", outcome.device.name},
            {"compute_units", outcome.device.compute_units},
            {"pe", shape(array.width, array.height)},
            {"lanes", array.lanes},
            {"tile", shape(array.tile_width, array.tile_height)}};
}

Json settings_json(const SolveOptions& options) {
    Json settings = Json::object();
    for (const auto& [option, value] : deciding_options(options)) {
        auto name = option.substr(2);
        std::replace(name.begin(), name.end(), '-', '_');
        const auto number = Json::parse(value, nullptr, false);
        settings[name] = number.is_number() ? number : Json(value);
    }
    return settings;
}

Json ledger_json(const std::vector<std::string>& names, const std::vector<Ledger>& ledgers) {
    Json bands = Json::object();
    for (std::size_t band = 0; band < names.size(); ++band) {
        const auto& ledger = ledgers[band];
        bands[names[band]] = {{"emitted", ledger.emitted},
                              {"absorbed", ledger.absorbed},
                              {"escaped", ledger.escaped},
                              {"unshot", ledger.unshot},
                              {"residual", ledger.residual()}};
    }
    return bands;
}

Json lights_json(const Solution& solution) {
    Json lights = Json::array();
    const auto layers = part_names(solution);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto& part = solution.parts[i];
        if (part.kind == SolutionPart::Kind::light)
            lights.push_back({{"name", part.name},
                              {"layer", layers[i]},
                              {"ledger", ledger_json(solution.bands, part.ledger)}});
    }
    return lights;
}

/// null where it was not asked for.
Json error_json(const Outcome& outcome) {
    if (!outcome.error) return nullptr;
    return {{"relative_rms", outcome.error->relative_rms},
            {"largest", outcome.error->largest},
            {"resolution", outcome.error->against.resolution},
            {"shooter_samples", outcome.error->against.shooter_samples}};
}

/// null where it was not asked for, or interrupted.
Json gather_json(const Outcome& outcome) {
    if (!outcome.gathered) return nullptr;
    return {{"texels_gathered", outcome.gathered->gathered()},
            {"texels_interpolated", outcome.gathered->interpolated()}};
}

Json lightmaps_json(const Mesh& mesh, const Outcome& outcome) {
    Json lightmaps = Json::array();
    for (const auto& [file, contents, covered_texels] : outcome.lightmaps) {
        Json objects = Json::array();
        for (const std::uint32_t object : contents.objects) objects.push_back(mesh.objects[object]);
        lightmaps.push_back({{"file", file.string()},
                             {"width", contents.width},
                             {"height", contents.height},
                             {"texel_size", contents.texel_size},
                             {"charts", contents.chart_count},
                             {"covered_texels", covered_texels},
                             {"objects", objects}});
    }
    return lightmaps;
}

Json seconds_json(const Outcome& outcome) {
    const auto& seconds = outcome.seconds;
    Json stages = Json::object();
    for (const auto& [kernel, spent] : seconds.per_kernel) stages[kernel] = spent.first;
    return {{"total", seconds.total},
            {"prepare", seconds.prepare},
            {"build_kernels", seconds.build_kernels},
            {"solve", seconds.solve},
            {"gather", seconds.gather},
            {"lightmap", seconds.lightmap},
            {"per_shot_median", seconds.per_shot_median},
            {"per_stage", stages}};
}

/// As told before the work began; null what was not.
Json estimate_json(const Outcome& outcome) {
    const auto& forecast = outcome.forecast;
    Json parts = Json::object();
    for (const MemoryPart& part : outcome.memory.parts) parts[part.name] = part.bytes;
    return {{"memory_bytes", outcome.memory.bytes()},
            {"compiler_bytes", outcome.memory.compiler_bytes},
            {"memory_parts", parts},
            {"shots", forecast ? Json(std::round(forecast->shots)) : Json(nullptr)},
            {"seconds", forecast ? Json(forecast->seconds) : Json(nullptr)}};
}

Json outputs_json(const Outcome& outcome) {
    Json outputs = Json::array();
    for (const auto& file : outcome.outputs) {
        const bool readable = std::filesystem::is_regular_file(file);
        outputs.push_back(
            {{"file", file.string()}, {"sha256", readable ? Json(sha256(file)) : Json(nullptr)}});
    }
    return outputs;
}

}  // namespace

void write_report(const std::filesystem::path& path, const SolveOptions& options, const Mesh& mesh,
                  const Outcome& outcome) {
    const Json report = {
        {"scene", scene_json(mesh)},
        {"device", device_json(outcome)},
        {"settings", settings_json(options)},
        {"shots", outcome.solution.shots},
        {"resumed_shots", outcome.resumed_shots},
        {"repeated_shots", outcome.repeated_shots},
        {"unshot_fraction", outcome.solution.unshot_fraction},
        {"ledger", ledger_json(outcome.solution.bands, outcome.solution.ledger)},
        {"lights", lights_json(outcome.solution)},
        {"error", error_json(outcome)},
        {"closure", {{"min", outcome.closure.least}, {"max", outcome.closure.most}}},
        {"gather", gather_json(outcome)},
        {"seconds", seconds_json(outcome)},
        {"estimate", estimate_json(outcome)},
        {"peak_memory_bytes", peak_memory_bytes()},
        {"lightmaps", lightmaps_json(mesh, outcome)},
        {"outputs", outputs_json(outcome)},
        {"warnings", outcome.warnings}};
    // Names in a scene may be in any encoding; JSON is UTF-8.
    const auto text = report.dump(2, ' ', false, Json::error_handler_t::replace);
    write_atomically(path, [&](std::ostream& out) { out << text << '\n'; });
}

}  // namespace hemirad
