#include "solver/solver.h"

#include <algorithm>

#include "errors.h"
#include "solver/assemble_solution.h"
#include "solver/stopwatch.h"

namespace hemirad {
namespace {

// The host looks at the device's progress about this often; shots in between need no round trip.
constexpr double kSecondsBetweenLooks = 0.1;
constexpr std::uint64_t kMostPassesBetweenLooks = 4096;
// Shots by known rows between two passes that would project; beyond, these cost little.
constexpr std::uint64_t kMostRepeats = 64;
constexpr std::uint64_t kDefaultRowBytes = std::uint64_t{1} << 30;
// Where fewer have a row, the rows spare next to nothing and cost more than all patches do.
constexpr std::uint64_t kMostShootersPerRow = 100;
constexpr std::uint32_t kSalvo = 8;
constexpr std::uint64_t kLeastShootersForSalvo = 1024, kMostPatchesForSalvo = 1u << 18;
constexpr std::uint32_t kFinestForSalvo = 2048;
// The device counts them in 32 bits.
constexpr std::uint64_t kMostShots = std::numeric_limits<std::uint32_t>::max();

std::vector<Shooter> shooters_of(const Mesh& mesh) {
    if (!mesh.shooters.empty()) return mesh.shooters;
    std::vector<Shooter> shooters;
    for (std::uint32_t i = 0; i < mesh.patches.size(); ++i)
        shooters.push_back({mesh.patches[i].corners, mesh.patches[i].surface, i, 1});
    return shooters;
}

std::vector<std::uint32_t> shooter_of_patches(const Mesh& mesh) {
    std::vector<std::uint32_t> result(mesh.patches.size());
    const auto shooters = shooters_of(mesh);
    for (std::uint32_t i = 0; i < shooters.size(); ++i)
        std::fill_n(result.begin() + shooters[i].first_patch, shooters[i].patch_count, i);
    return result;
}

std::vector<std::uint32_t> by_patch(const Mesh& mesh, const std::vector<std::uint32_t>& shots_of) {
    auto result = shooter_of_patches(mesh);
    for (std::uint32_t& patch : result) patch = shots_of[patch];
    return result;
}

double area_of(const Mesh& mesh, const Shooter& shooter) {
    double area = 0;
    for (std::uint32_t i = 0; i < shooter.patch_count; ++i)
        area += mesh.area(mesh.patches[shooter.first_patch + i]);
    return area;
}

PatchLight patch_light(const Mesh& mesh, const BandPlan& plan, std::uint32_t stride) {
    PatchLight light;
    const auto shooters = shooters_of(mesh);
    light.band_count = plan.solved.size();
    light.emitted.resize(light.band_count * stride);
    light.reflectance.resize(light.band_count * stride);
    for (std::size_t band = 0; band < light.band_count; ++band) {
        const SolvedBand& solved = plan.solved[band];
        const double emitted = emitted_flux(mesh, plan.lights, solved);
        // Who shoots, and how often, is up to the whole of the light, of which direct light is
        // part.
        light.band_weight.push_back(emitted > 0 && solved.reflects ? 1.0f : 0.0f);
        for (std::size_t i = 0; i < shooters.size(); ++i) {
            const Patch& patch = mesh.patches[shooters[i].first_patch];
            const double own = emitted_radiosity(mesh, plan.lights, patch, solved);
            if (own > 0)
                light.emitted[band * stride + i] =
                    static_cast<float>(own * area_of(mesh, shooters[i]) / emitted);
            if (solved.reflects)
                light.reflectance[band * stride + i] = reflectance(mesh, patch, solved.band);
        }
    }
    return light;
}

// Beyond, what cannot be told from the mesh (what hides what) errs more than nearness does.
constexpr std::int32_t kMostAutomaticSamples = 8;

// Counting needs more hemispheres where patches are near; analytic factors have closed forms.
void set_shooter_sampling(PipelineSettings& pipeline, const Mesh& mesh,
                          const SolverSettings& settings) {
    pipeline.shooter_samples = std::max(1u, settings.shooter_samples);
    if (settings.form_factor == FormFactorMode::analytic)
        pipeline.near_pairs = near_pairs(mesh, settings.sampling_error);
    else if (settings.shooter_samples == 0)
        pipeline.patch_samples =
            shooter_samples_for(mesh, settings.sampling_error, kMostAutomaticSamples);
}

PipelineSettings pipeline_settings(const Mesh& mesh, const SolverSettings& settings,
                                   const mp1map::DeviceSummary& device) {
    PipelineSettings result;
    result.resolution = settings.resolution;
    result.form_factor = settings.form_factor;
    set_shooter_sampling(result, mesh, settings);
    result.tolerance = settings.tolerance;
    result.salvo = usable_salvo(settings.salvo, mesh.shooter_count(), mesh.patches.size(),
                                settings.resolution);
    result.row_bytes =
        usable_row_bytes(settings.row_bytes, mesh.shooter_count(), mesh.patches.size(), device);
    result.pe_array = settings.pe_array;
    result.variants = settings.variants;
    result.kernels_dir = settings.kernels_dir;
    result.timed = settings.timed;
    result.count_shots = settings.count_shots;
    return result;
}

ShotPipeline pipeline_for(const Mesh& mesh, const BandPlan& plan, const SolverSettings& settings,
                          const mp1map::Device& device) {
    const PatchArrays patches =
        patch_arrays(mesh, settings.form_factor == FormFactorMode::analytic);
    const ShooterArrays shooters = shooter_arrays(mesh, patches);
    const std::uint32_t stride = mesh.shooters.empty() ? patches.stride : shooters.polygons.stride;
    return ShotPipeline(patches, patch_light(mesh, plan, stride),
                        pipeline_settings(mesh, settings, device.summary()), device, shooters);
}

// choose_shooter adds up every band for each of its PEs in local memory, beside 8 bytes for each
// of a salvo and of those that may look ahead.
constexpr std::uint64_t kReduceBytesPerBand = 4, kReduceBytes = 16 * kMostSalvo;
// update_unshot: 16 sums of a band, which PoCL keeps for all PEs of an array on one thread's stack.
// 26 MB of them were seen to run, 65 MB to crash.
constexpr std::uint64_t kSumBytesPerBand = 64, kMostSumBytes = 1 << 24;
constexpr std::uint64_t kMostBands = 512;  // more were not tried

BandPlan planned(const Mesh& mesh, const SolverSettings& settings,
                 const mp1map::DeviceSummary& device) {
    BandPlan plan = plan_bands(mesh, settings.parts);
    const auto most = most_bands(device, mp1map::fit_pe_array(device, settings.pe_array));
    if (plan.solved.size() > most)
        throw InputError(std::to_string(plan.solved.size()) + " bands to solve at once; " +
                         device.name + " takes " + std::to_string(most));
    return plan;
}

}  // namespace

std::uint64_t most_bands(const mp1map::DeviceSummary& device, const mp1map::PeArray& array) {
    const std::uint64_t bytes = device.local_memory / kReducePes;
    return std::min({bytes > kReduceBytes ? (bytes - kReduceBytes) / kReduceBytesPerBand : 0,
                     kMostSumBytes / (kSumBytesPerBand * array.pe_count()), kMostBands});
}

std::uint64_t usable_row_bytes(const std::optional<std::uint64_t>& wanted, std::uint64_t shooters,
                               std::uint64_t patches, const mp1map::DeviceSummary& device) {
    const std::uint64_t bytes =
        std::min({wanted.value_or(kDefaultRowBytes), device.global_memory / 4,
                  device.max_allocation, kMostRowBytes});
    const bool worthwhile = bytes * kMostShootersPerRow >= shooters * 4 * patches;
    return wanted || worthwhile ? bytes : 0;
}

std::uint32_t usable_salvo(std::uint32_t wanted, std::uint64_t shooters, std::uint64_t patches,
                           std::uint32_t resolution) {
    if (wanted != 0) return std::min(wanted, kMostSalvo);
    const bool fits = patches <= kMostPatchesForSalvo && resolution <= kFinestForSalvo;
    return shooters >= kLeastShootersForSalvo && fits ? kSalvo : 1;
}

ProgressiveSolver::ProgressiveSolver(const Mesh& mesh, const SolverSettings& settings,
                                     const mp1map::Device& device)
    : mesh_(mesh),
      settings_(settings),
      plan_(planned(mesh, settings, device.summary())),
      pipeline_(pipeline_for(mesh, plan_, settings, device)) {
    pipeline_.init_plane();
    find_first_shooters();
}

// By a shot at nothing, which adds up the flux that is unshot.
void ProgressiveSolver::find_first_shooters() {
    pipeline_.set_shot_limit(settings_.max_shots, settings_.max_shots);
    distribute_flux(pipeline_);
}

// The inner loops of sec. 1.5.4, over the levels of the stacks and their patches, run inside the
// kernels.
void project_aimed(ShotPipeline& pipeline) {
    pipeline.prepare_patches();
    pipeline.prefix_sum();
    pipeline.bin_areas();
    pipeline.project_patches();
    if (pipeline.mode() == FormFactorMode::analytic) pipeline.estimate_form_factors();
}

void project_hemisphere(ShotPipeline& pipeline) {
    pipeline.aim_hemisphere();
    project_aimed(pipeline);
}

void project_shooter(ShotPipeline& pipeline, std::uint32_t patch) {
    pipeline.clear_counts();
    for (;;) {
        pipeline.set_shooter(patch);
        for (std::uint32_t part = 0; part < pipeline.part_count(patch); ++part)
            project_hemisphere(pipeline);
        if (pipeline.shot().status != kBinsFull) return;
        pipeline.enlarge_lists();
    }
}

void close_form_factors(ShotPipeline& pipeline) {
    pipeline.correct_near_pairs();
    pipeline.add_up_factors();
    pipeline.spread_residual();
}

void distribute_flux(ShotPipeline& pipeline) {
    pipeline.receive_flux();
    pipeline.choose_shooter();
}

void shoot(ShotPipeline& pipeline) {
    project_hemisphere(pipeline);
    if (pipeline.mode() == FormFactorMode::analytic) close_form_factors(pipeline);
    distribute_flux(pipeline);
}

// What the device finds nothing to do for does nothing: passes once it is done, repeats for a
// shooter whose row is not known. Twice as many repeats as the passes before met follow each.
Progress ProgressiveSolver::advance(std::uint64_t passes) {
    const std::uint64_t repeated_before = pipeline_.shot().repeated_salvos;
    for (std::uint64_t pass = 0; pass < passes; ++pass) {
        shoot(pipeline_);
        for (std::uint64_t repeat = 0; repeat < repeats_; ++repeat) distribute_flux(pipeline_);
    }
    device::Shot state = pipeline_.shot();
    const std::uint64_t repeated = state.repeated_salvos - repeated_before;
    repeats_ = std::min(kMostRepeats, (2 * repeated + passes - 1) / passes);
    if (state.status == kBinsFull) {
        pipeline_.enlarge_lists();
        state = pipeline_.shot();
    }
    return {state.shots, state.unshot_fraction, 0};
}

bool ProgressiveSolver::may_be_cut_short(std::uint64_t shots) const {
    return shots + pipeline_.salvo() > settings_.max_shots;
}

std::uint64_t ProgressiveSolver::next_pause(std::uint64_t shots) const {
    std::uint64_t pause = settings_.max_shots;
    if (!may_be_cut_short(shots)) pause -= pipeline_.salvo() - 1;
    for (const std::uint64_t every : settings_.stop_every)
        if (every != 0) pause = std::min(pause, (shots / every + 1) * every);
    return pause;
}

std::uint64_t ProgressiveSolver::passes_to(std::uint64_t shots) const {
    return std::min(shots, kMostPassesBetweenLooks) * pipeline_.most_parts();
}

Stop ProgressiveSolver::solve(const std::function<bool(const Progress&)>& on_progress) {
    const Stopwatch stopwatch;
    std::uint64_t batch = 1;
    for (;;) {
        const device::Shot state = pipeline_.shot();
        if (state.status == kConverged || state.status == kExhausted) return Stop::converged;
        if (!uncut_ && may_be_cut_short(state.shots)) uncut_ = pipeline_.state();
        if (state.shots >= std::min<std::uint64_t>(settings_.max_shots, kMostShots))
            return Stop::max_shots;
        const std::uint64_t pause = next_pause(state.shots);
        pipeline_.set_shot_limit(pause, settings_.max_shots);

        const double before = stopwatch.seconds();
        const std::uint64_t passes = std::min(batch, passes_to(pause - state.shots));
        Progress progress = advance(passes);
        progress.seconds = stopwatch.seconds();
        const double per_pass = (progress.seconds - before) / static_cast<double>(passes);
        batch = std::clamp<std::uint64_t>(
            static_cast<std::uint64_t>(kSecondsBetweenLooks / std::max(per_pass, 1e-9)), 1,
            std::min(2 * batch, kMostPassesBetweenLooks));

        if (!on_progress(progress)) return Stop::interrupted;
        if (progress.seconds >= settings_.time_limit) return Stop::time_limit;
    }
}

std::optional<Forecast> ProgressiveSolver::forecast(double least_seconds,
                                                    const std::function<bool()>& go_on) {
    const PatchLight light = patch_light(mesh_, plan_, pipeline_.shooter_stride());
    const auto result = hemirad::forecast(
        pipeline_,
        {light, shooter_of_patches(mesh_), static_cast<std::uint32_t>(mesh_.shooter_count()),
         settings_.tolerance, settings_.max_shots, least_seconds, go_on});
    pipeline_.acu().forget_seconds();
    find_first_shooters();
    return result;
}

void ProgressiveSolver::resume(const SolveState& state) {
    pipeline_.set_state(state);
    find_first_shooters();
}

SolveState ProgressiveSolver::state() {
    SolveState state = pipeline_.state();
    return uncut_ && state.shots >= settings_.max_shots ? *uncut_ : state;
}

Solution ProgressiveSolver::solution() {
    const device::Shot state = pipeline_.shot();
    Solution solution =
        assemble_solution(mesh_, plan_,
                          {pipeline_.stride(), pipeline_.shooter_stride(), pipeline_.received(),
                           pipeline_.unshot(), pipeline_.escaped()});
    solution.shots = state.shots;
    if (settings_.count_shots) solution.shots_of = by_patch(mesh_, pipeline_.shots_of());
    solution.unshot_fraction = state.unshot_fraction;
    solution.converged = state.status == kConverged || state.status == kExhausted;
    return solution;
}

Closure ProgressiveSolver::closure() {
    const device::Shot state = pipeline_.shot();
    if (state.shots == 0) return {};
    const double disk = static_cast<double>(pipeline_.disk_proxels());
    return {1 + state.least_surplus / disk, 1 + state.most_surplus / disk};
}

std::uint64_t ProgressiveSolver::repeated_shots() { return pipeline_.shot().repeated_shots; }

const mp1map::PeArray& ProgressiveSolver::pe_array() const { return pipeline_.pe_array(); }

std::uint64_t ProgressiveSolver::device_bytes() const { return pipeline_.device_bytes(); }

double ProgressiveSolver::build_seconds() const { return pipeline_.build_seconds(); }

std::map<std::string, std::pair<double, std::uint64_t>> ProgressiveSolver::kernel_seconds() {
    return pipeline_.acu().kernel_seconds();
}

}  // namespace hemirad
