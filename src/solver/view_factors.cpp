#include "solver/view_factors.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "solver/contacts.h"
#include "solver/exact_pairs.h"
#include "solver/hemisphere_rows.h"
#include "solver/near_pairs.h"
#include "solver/patch_spheres.h"

namespace hemirad {
namespace {

// With a target, near pairs are integrated; more hemispheres are dearer than the pairs they spare.
constexpr std::uint32_t kSamplesWithTarget = 2;
// Without, what SolverSettings take.
constexpr double kSamplingError = 1e-3;
constexpr std::int32_t kMostSamples = 8;

// Every part is a solid, or a sheet with a back: what a ray hits from one side
// it hits from both.
bool hides_both_ways(const Mesh& mesh) {
    return !mesh.parts.empty() && std::ranges::all_of(mesh.parts, [](const Part& part) {
        return part.closed || part.back_patches > 0;
    });
}

double square(double x) { return x * x; }

// Centre to centre; near patches, of which a centre may see nothing, by the closed form.
double unblocked(const PatchShape& from, const PatchShape& to) {
    const glm::dvec3 gap = to.centre - from.centre;
    const double squared = glm::dot(gap, gap), reach = from.radius + to.radius;
    if (squared < square(2 * reach)) return polygon_to_polygon(from.corners, to.corners);
    const double above_from = glm::dot(from.normal, gap), above_to = -glm::dot(to.normal, gap);
    if (above_from <= 0 || above_to <= 0) return 0;
    return to.area * above_from * above_to / (squared * (std::numbers::pi * squared + to.area));
}

struct Entry {
    FormFactor factor;
    bool exact;
};

struct Row {
    std::vector<Entry> entries;  // ascending in factor.to
    double outside, outside_error;
};

Row row_of(const ProxelRow& proxels, std::uint32_t from, const std::vector<PatchShape>& patches,
           std::uint32_t resolution) {
    const HemisphereError error{resolution, std::sqrt(double(proxels.part_count))};
    Row row;
    for (std::uint32_t to = 0; to < proxels.owned.size(); ++to) {
        if (proxels.owned[to] == 0) continue;
        const double value = double(proxels.owned[to]) / double(proxels.all);
        const double larger = std::max(value, unblocked(patches[from], patches[to]));
        row.entries.push_back(
            {{to, float(error.of(larger, patches[from], patches[to])), value}, false});
    }
    row.outside = double(proxels.escaped) / double(proxels.all);
    row.outside_error = proxels.escaped == 0 ? 0 : error.of_whole(row.outside);
    return row;
}

// `exact` is ascending in `to`.
void put(const std::vector<Entry>& exact, std::vector<Entry>& entries) {
    std::vector<Entry> merged;
    const auto before = [](const Entry& a, const Entry& b) { return a.factor.to < b.factor.to; };
    // Of equal ones, set_union takes the first range's.
    std::ranges::set_union(exact, entries, std::back_inserter(merged), before);
    std::erase_if(merged, [](const Entry& entry) { return entry.factor.value <= 0; });
    entries = std::move(merged);
}

double residual(const Row& row) {
    double sum = row.outside;
    for (const Entry& entry : row.entries) sum += entry.factor.value;
    return 1 - sum;
}

// Least squares: what is missing goes to what is uncertain, by the squares of
// the errors; what would become negative stops at 0 and leaves the rest to the
// others.
void spread_residual(Row& row) {
    for (int round = 0; round < 30; ++round) {
        const double missing = residual(row);
        double weights = row.outside > 0 ? square(row.outside_error) : 0;
        for (const Entry& entry : row.entries)
            if (!entry.exact && entry.factor.value > 0) weights += square(entry.factor.error);
        if (std::abs(missing) < 1e-15 || weights <= 0) return;
        if (row.outside > 0)
            row.outside =
                std::max(0.0, row.outside + missing * square(row.outside_error) / weights);
        for (Entry& entry : row.entries) {
            double& value = entry.factor.value;
            if (!entry.exact && value > 0)
                value = std::max(0.0, value + missing * square(entry.factor.error) / weights);
        }
    }
}

// Sum and outside make 1. What still lacks is known of nothing, and so goes to the outside.
void close(Row& row) {
    const bool all_exact =
        std::ranges::all_of(row.entries, [](const Entry& entry) { return entry.exact; });
    if (all_exact)
        row.outside = std::max(0.0, row.outside + residual(row));
    else
        spread_residual(row);
    const double left = residual(row);
    constexpr double kRounding = 1e-9;
    if (left > 0 && (row.outside > 0 || left > kRounding)) {
        row.outside += left;
        return;
    }
    const double scale = 1 / (1 - left);
    for (Entry& entry : row.entries) entry.factor.value *= scale;
    row.outside *= scale;
}

std::vector<std::uint32_t> rows_wanted(const Mesh& mesh, const ViewFactorSettings& settings) {
    if (!settings.from.empty()) return settings.from;
    std::vector<std::uint32_t> all(mesh.patches.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

PipelineSettings pipeline_settings(const Mesh& mesh, const ViewFactorSettings& settings) {
    PipelineSettings result;
    result.resolution = settings.resolution;
    result.shooter_samples =
        settings.shooter_samples == 0 ? kSamplesWithTarget : settings.shooter_samples;
    if (settings.shooter_samples == 0 && !settings.target_error)
        result.patch_samples = shooter_samples_for(mesh, kSamplingError, kMostSamples);
    result.pe_array = settings.pe_array;
    result.kernels_dir = settings.kernels_dir;
    return result;
}

// What was not integrated is known to be within the target.
void put_exact(const std::vector<ExactPair>& pairs, const std::vector<std::uint32_t>& from,
               double target, std::vector<Row>& rows, const std::vector<Contact>& touching,
               const std::vector<PatchShape>& patches) {
    std::vector<std::vector<Entry>> exact(patches.size());
    for (const Contact& contact : touching) {
        const auto& [i, j, area] = contact;
        exact[i].push_back({{j, 0, std::min(1.0, area / patches[i].area)}, true});
        exact[j].push_back({{i, 0, std::min(1.0, area / patches[j].area)}, true});
    }
    for (const ExactPair& pair : pairs)
        exact[pair.from].push_back({{pair.to, float(pair.factor.error), pair.factor.value}, true});
    for (std::size_t row = 0; row < rows.size(); ++row) {
        auto& entries = exact[from[row]];
        std::ranges::sort(entries, {}, [](const Entry& entry) { return entry.factor.to; });
        for (Entry& entry : rows[row].entries)
            entry.factor.error = std::min(entry.factor.error, float(target));
        put(entries, rows[row].entries);
        close(rows[row]);
    }
}

FormFactors factors_of(const std::vector<std::uint32_t>& from, const std::vector<Row>& rows,
                       const Mesh& mesh) {
    FormFactors factors;
    for (const Patch& patch : mesh.patches) factors.area.push_back(mesh.area(patch));
    for (std::size_t row = 0; row < rows.size(); ++row) {
        factors.from.push_back(from[row]);
        factors.outside.push_back(rows[row].outside);
        auto& list = factors.rows.emplace_back();
        for (const Entry& entry : rows[row].entries)
            if (entry.factor.value > 0) list.push_back(entry.factor);
    }
    return factors;
}

}  // namespace

FormFactors view_factors(const Mesh& mesh, const ViewFactorSettings& settings,
                         const mp1map::Device& device, const RowProgress& on_progress) {
    const auto patches = patch_shapes(mesh);
    const auto from = rows_wanted(mesh, settings);
    const PipelineSettings pipeline = pipeline_settings(mesh, settings);
    const HemisphereError error{pipeline.resolution, double(pipeline.shooter_samples)};
    const std::size_t steps = settings.target_error ? 2 * from.size() : from.size();
    std::vector<Row> rows;
    HemisphereRows hemispheres(mesh, pipeline, device);
    // A row is put together while the device is at the next one.
    std::future<Row> last;
    bool goes_on = true;
    for (const std::uint32_t patch : from) {
        ProxelRow proxels = hemispheres.row(patch);
        if (last.valid()) rows.push_back(last.get());
        last = std::async(std::launch::async, [&, patch, seen = std::move(proxels)] {
            return row_of(seen, patch, patches, settings.resolution);
        });
        goes_on = on_progress(rows.size() + 1, steps);
        if (!goes_on) break;
    }
    if (last.valid()) rows.push_back(last.get());
    if (!goes_on) return factors_of(from, rows, mesh);
    if (settings.target_error) {
        const auto touching = contacts(mesh, patches);
        std::vector<bool> covered(patches.size(), false);
        for (const Contact& contact : touching)
            covered[contact.first] = covered[contact.second] = true;
        const ExactPairs exact(patches, error, *settings.target_error, hides_both_ways(mesh),
                               std::move(covered));
        const auto pairs = exact.integrate(
            from, [&](std::size_t done) { return on_progress(from.size() + done, steps); });
        put_exact(pairs, from, *settings.target_error, rows, touching, patches);
    }
    return factors_of(from, rows, mesh);
}

}  // namespace hemirad
