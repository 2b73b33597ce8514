#include "solver/forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "solver/solver.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

constexpr std::uint32_t kMostGroups = 256, kLeastMembers = 4, kLeastGroups = 16;
// What is planned; the rest is for looks that take longer than the one that was timed.
constexpr double kPlannedSeconds = 0.75 * kMostForecastSeconds;
constexpr double kSecondsBetweenQuestions = 0.1;
// Looks are timed so often, and the last time counts: in the first more is new to the machine.
constexpr std::size_t kTurns = 2;
constexpr std::size_t kLooksOfGroup = 1 + kTurns;

using Table = std::vector<std::vector<double>>;

using Group = std::vector<std::uint32_t>;  // shooters, in their order

// The member that looks for the others.
std::uint32_t middle_of(const Group& group) { return group[group.size() / 2]; }

/// Groups, and the flux from each to each.
struct Exchange {
    std::vector<Group> groups;
    Table factor;       // [from][to]
    Table unshot;       // [band][group], parts of what the band emits
    Table reflectance;  // [band][group]
};

// Members of a group reflect alike, to multiples of `step`, and emit or do not.
std::vector<float> material_of(const PatchLight& light, std::size_t stride, std::uint32_t shooter,
                               float step) {
    std::vector<float> material;
    for (std::size_t band = 0; band < light.band_count; ++band) {
        const float reflectance = light.reflectance[band * stride + shooter];
        material.push_back(step > 0 ? std::round(reflectance / step) : reflectance);
        material.push_back(light.emitted[band * stride + shooter] > 0 ? 1.0f : 0.0f);
    }
    return material;
}

bool has_more_materials(const PatchLight& light, std::size_t stride, std::uint32_t shooters,
                        float step, std::size_t most) {
    std::set<std::vector<float>> materials;
    for (std::uint32_t shooter = 0; shooter < shooters && materials.size() <= most; ++shooter)
        materials.insert(material_of(light, stride, shooter, step));
    return materials.size() > most;
}

// The finest that leaves no more materials than groups are wanted, each of which looks.
float step_of_reflectance(const PatchLight& light, std::size_t stride, std::uint32_t shooters,
                          std::uint32_t wanted) {
    if (!has_more_materials(light, stride, shooters, 0, wanted)) return 0;
    float step = 1.0f / 64;
    while (step < 1 && has_more_materials(light, stride, shooters, step, wanted)) step *= 2;
    return step;
}

std::vector<Group> group_shooters(const PatchLight& light, std::size_t stride,
                                  std::uint32_t shooters, std::uint32_t wanted) {
    const std::size_t most = std::max(kLeastMembers, shooters / wanted + 1);
    const float step = step_of_reflectance(light, stride, shooters, wanted);
    std::map<std::vector<float>, std::size_t> open;  // the group of a material that is not full
    std::vector<Group> groups;
    for (std::uint32_t shooter = 0; shooter < shooters; ++shooter) {
        const auto [place, is_new] =
            open.try_emplace(material_of(light, stride, shooter, step), groups.size());
        if (is_new || groups[place->second].size() == most) {
            place->second = groups.size();
            groups.emplace_back();
        }
        groups[place->second].push_back(shooter);
    }
    return groups;
}

using Pass = void (*)(ShotPipeline&);

/// The pipeline to ask, and its state before its first shot, with the closure of those made to ask.
struct Asked {
    ShotPipeline& pipeline;
    SolveState state;
    const std::function<bool()>& go_on;
    std::size_t passes_unasked = 1;  // that take about kSecondsBetweenQuestions
};

/// False where it was stopped on the way.
bool make_passes(Asked& asked, std::size_t count, Pass pass) {
    while (count > 0) {
        const Stopwatch stopwatch;
        const std::size_t passes = std::min(count, asked.passes_unasked);
        for (std::size_t i = 0; i < passes; ++i) pass(asked.pipeline);
        asked.pipeline.shot();  // the device has made them
        if (!asked.go_on()) return false;
        const double fitting = kSecondsBetweenQuestions * static_cast<double>(passes) /
                               std::max(stopwatch.seconds(), 1e-9);
        asked.passes_unasked =
            static_cast<std::size_t>(std::clamp(fitting, 1.0, 2.0 * static_cast<double>(passes)));
        count -= passes;
    }
    return true;
}

/// Until these have shot, of equal flux. Returns how many shots that were: fewer where too little
/// was left to the last ones; nothing where it was stopped.
std::optional<std::uint32_t> let_shoot(Asked& asked, const std::vector<std::uint32_t>& shooters,
                                       Pass pass = shoot) {
    ShotPipeline& pipeline = asked.pipeline;
    SolveState state = asked.state;
    std::ranges::fill(state.unshot, 0.0f);
    for (std::size_t band = 0; band < pipeline.band_count(); ++band)
        for (const std::uint32_t shooter : shooters)
            state.unshot[band * pipeline.shooter_stride() + shooter] =
                1 / static_cast<float>(shooters.size());
    pipeline.set_state(state);
    pipeline.set_shot_limit(shooters.size(), shooters.size());
    distribute_flux(pipeline);
    const std::size_t salvos = (shooters.size() + pipeline.salvo() - 1) / pipeline.salvo();
    device::Shot shot{};
    do {
        if (!make_passes(asked, salvos * pipeline.most_parts(), pass)) return {};
        shot = pipeline.shot();
        if (shot.status == kBinsFull) pipeline.enlarge_lists();
        pass = shoot;
    } while (shot.status == kBinsFull || shot.status == kRunning);
    asked.state.least_surplus = shot.least_surplus;
    asked.state.most_surplus = shot.most_surplus;
    return shot.shots;
}

std::optional<double> seconds_a_shot(Asked& asked, const std::vector<std::uint32_t>& shooters,
                                     Pass pass = shoot) {
    const Stopwatch stopwatch;
    const auto shots = let_shoot(asked, shooters, pass);
    if (!shots) return {};
    return stopwatch.seconds() / std::max(*shots, 1u);
}

/// What each group's patches receive of one unit that a group's middle shoots.
std::optional<Table> factors_of(Asked& asked, const ForecastTask& task,
                                const std::vector<Group>& groups) {
    std::vector<std::uint32_t> group_of(task.shooters);
    for (std::uint32_t i = 0; i < groups.size(); ++i)
        for (const std::uint32_t member : groups[i]) group_of[member] = i;
    Table factor;
    for (const Group& group : groups) {
        if (!let_shoot(asked, {middle_of(group)})) return {};
        const auto received = asked.pipeline.received();
        factor.emplace_back(groups.size());
        for (std::size_t patch = 0; patch < task.shooter_of.size(); ++patch)
            factor.back()[group_of[task.shooter_of[patch]]] += received[patch];
    }
    return factor;
}

void add_light(const PatchLight& light, std::size_t stride, Exchange& exchange) {
    for (std::size_t band = 0; band < light.band_count; ++band) {
        exchange.unshot.emplace_back();
        exchange.reflectance.emplace_back();
        for (const Group& group : exchange.groups) {
            double emitted = 0, reflectance = 0;
            for (const std::uint32_t member : group) {
                emitted += light.emitted[band * stride + member];
                reflectance += light.reflectance[band * stride + member];
            }
            exchange.unshot.back().push_back(emitted);
            exchange.reflectance.back().push_back(reflectance / static_cast<double>(group.size()));
        }
    }
}

double unshot_fraction(const Exchange& exchange, const PatchLight& light) {
    double most = 0;
    for (std::size_t band = 0; band < light.band_count; ++band) {
        double sum = 0;
        for (const double flux : exchange.unshot[band]) sum += flux;
        most = std::max(most, sum * light.band_weight[band]);
    }
    return most;
}

/// Unshot flux of a member, as choose_shooter weighs it.
double energy_of(const Exchange& exchange, const PatchLight& light, std::size_t group) {
    double sum = 0;
    for (std::size_t band = 0; band < light.band_count; ++band)
        sum += exchange.unshot[band][group] * light.band_weight[band];
    return sum / static_cast<double>(exchange.groups[group].size());
}

void shoot_group(Exchange& exchange, std::size_t from) {
    for (std::size_t band = 0; band < exchange.unshot.size(); ++band) {
        const double flux = exchange.unshot[band][from];
        exchange.unshot[band][from] = 0;
        for (std::size_t to = 0; to < exchange.groups.size(); ++to)
            exchange.unshot[band][to] +=
                flux * exchange.factor[from][to] * exchange.reflectance[band][to];
    }
}

/// Shots and looks. Rows are kept in the order of their shooters' first shots, as long as there is
/// room.
Forecast shoot_groups(Exchange exchange, const ForecastTask& task, double room) {
    Forecast result;
    std::vector<std::optional<double>> kept(exchange.groups.size());  // share of the members' rows
    std::vector<double> energies(exchange.groups.size());
    const auto most = static_cast<double>(task.max_shots);
    while (result.shots < most && unshot_fraction(exchange, task.light) >= task.tolerance) {
        for (std::size_t i = 0; i < energies.size(); ++i)
            energies[i] = energy_of(exchange, task.light, i);
        const auto next =
            static_cast<std::size_t>(std::ranges::max_element(energies) - energies.begin());
        if (!(energies[next] > std::numeric_limits<float>::min())) break;
        const auto members = static_cast<double>(exchange.groups[next].size());
        result.shots += members;
        result.looks += members * (1 - kept[next].value_or(0));
        if (!kept[next]) {
            kept[next] = std::min(1.0, room / members);
            room -= members * *kept[next];
        }
        shoot_group(exchange, next);
    }
    result.shots = std::min(result.shots, most);
    result.looks = std::min(result.looks, most);
    return result;
}

/// So many that their looks take no longer than they may; none where the fewest take longer.
std::vector<Group> groups_in_time(const ForecastTask& task, std::size_t stride,
                                  double look_seconds) {
    const double most = kPlannedSeconds / (kLooksOfGroup * std::max(look_seconds, 1e-9));
    auto wanted = static_cast<std::uint32_t>(std::clamp<double>(most, kLeastGroups, kMostGroups));
    for (;; wanted = std::max(wanted / 2, kLeastGroups)) {
        auto groups = group_shooters(task.light, stride, task.shooters, wanted);
        if (static_cast<double>(groups.size()) <= most) return groups;
        if (wanted == kLeastGroups) return {};
    }
}

std::optional<Exchange> exchange_of(Asked& asked, const ForecastTask& task, double look_seconds) {
    const std::size_t stride = asked.pipeline.shooter_stride();
    Exchange exchange;
    exchange.groups = groups_in_time(task, stride, look_seconds);
    if (exchange.groups.empty()) return {};
    auto factor = factors_of(asked, task, exchange.groups);
    if (!factor) return {};
    exchange.factor = std::move(*factor);
    add_light(task.light, stride, exchange);
    return exchange;
}

/// By members that have not looked yet, in salvos as in a solve; `otherwise` where groups have
/// none.
std::optional<double> seconds_a_look(Asked& asked, const std::vector<Group>& groups,
                                     double otherwise) {
    std::optional<double> seconds = otherwise;
    for (std::size_t turn = 0; turn < kTurns; ++turn) {
        std::vector<std::uint32_t> shooters;
        for (const Group& group : groups)
            if (group.size() > 2 * kTurns)
                shooters.push_back(group[group.size() * (1 + 2 * turn) / (2 * kTurns)]);
        if (!shooters.empty()) seconds = seconds_a_shot(asked, shooters);
        if (!seconds) break;
    }
    return seconds;
}

std::optional<double> seconds_a_repeat(Asked& asked, const std::vector<Group>& groups) {
    std::vector<std::uint32_t> middles;
    for (const Group& group : groups) middles.push_back(middle_of(group));
    return seconds_a_shot(asked, middles, distribute_flux);
}

std::optional<Forecast> foretold(Asked& asked, const ForecastTask& task) {
    const auto look = seconds_a_shot(asked, {task.shooters / 2});
    if (!look) return {};
    const auto most_looks = std::min<std::uint64_t>(task.shooters, task.max_shots);
    if (*look * static_cast<double>(most_looks) < task.least_seconds) return {};
    const auto exchange = exchange_of(asked, task, *look);
    if (!exchange) return {};
    const double room = asked.pipeline.room_for_rows();
    Forecast result = shoot_groups(*exchange, task, room);
    const auto in_salvos = seconds_a_look(asked, exchange->groups, *look);
    if (!in_salvos) return {};
    result.seconds = result.looks * *in_salvos;
    if (room < static_cast<double>(exchange->groups.size())) return result;
    const auto repeat = seconds_a_repeat(asked, exchange->groups);
    if (!repeat) return {};
    result.seconds += (result.shots - result.looks) * *repeat;
    return result;
}

}  // namespace

std::optional<Forecast> forecast(ShotPipeline& pipeline, const ForecastTask& task) {
    std::optional<Stopwatch> looking;
    const std::function<bool()> go_on = [&] {
        return task.go_on() && (!looking || looking->seconds() < kMostForecastSeconds);
    };
    Asked asked{pipeline, pipeline.state(), go_on};
    std::optional<Forecast> result;
    if (let_shoot(asked, {0})) {  // a first launch takes longer, where kernels are compiled minutes
        looking.emplace();
        result = foretold(asked, task);
    }
    pipeline.clear_counts();  // of a look that was stopped
    pipeline.set_state(asked.state);
    return result;
}

}  // namespace hemirad
