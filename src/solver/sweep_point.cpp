#include "solver/sweep_point.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

#include "solver/solver.h"

namespace hemirad {
namespace {

constexpr std::size_t kWarmUpShots = 2;
// Rounds over the shooters; no further one once so much time is spent.
constexpr int kMostRounds = 5;
constexpr double kSecondsForRounds = 1.5;

PipelineSettings settings_of(const SweepPoint& point) {
    PipelineSettings settings;
    settings.resolution = point.resolution;
    settings.pe_array = point.pe_array;
    settings.variants = point.variants;
    return settings;
}

ShotPipeline pipeline_for(const SweepScene& scene, const PipelineSettings& settings,
                          const mp1map::Device& device) {
    ShotPipeline pipeline(scene.patches(), even_light(scene.patches()), settings, device);
    pipeline.init_plane();
    return pipeline;
}

void shoot_from(ShotPipeline& pipeline, std::uint32_t shooter) {
    for (;;) {
        pipeline.set_shooter(shooter);
        shoot(pipeline);
        if (pipeline.shot().status != kBinsFull) return;
        pipeline.enlarge_lists();
    }
}

mp1map::ProxelRange range_of(std::uint32_t first_and_last) {
    return {first_and_last & 0xffff, first_and_last >> 16};
}

PlaneView view_of(ShotPipeline& pipeline) {
    constexpr mp1map::ProxelRange kEmpty{1, 0};
    PlaneView view;
    const auto projections = pipeline.projections();
    const auto rectangles = pipeline.rectangles();
    std::size_t next = 0;
    for (const std::int32_t patch : pipeline.visible_patches()) {
        view.visible.push_back({kEmpty, kEmpty, static_cast<std::uint32_t>(patch)});
        if (next == projections.size() || projections[next].patch != patch) continue;
        view.visible.back().columns = range_of(rectangles[next].columns);
        view.visible.back().rows = range_of(rectangles[next].rows);
        ++next;
    }
    view.useful_proxels = pipeline.activity().useful_proxels;
    return view;
}

std::uint64_t steps_of_blocks(mp1map::ProxelRange proxels, std::uint32_t resolution,
                              std::uint32_t pes) {
    const std::uint32_t block = (resolution + pes - 1) / pes;
    return std::min(proxels.last - proxels.first + 1, block);
}

std::uint64_t areas_visited(const PlaneView::Rectangle& patch, const SweepPoint& point) {
    if (point.pe_array.layout == mp1map::Layout::cyclic)
        return mp1map::areas_touched(patch.columns, patch.rows, point.mp1_width, point.mp1_height);
    return steps_of_blocks(patch.columns, point.resolution, point.mp1_width) *
           steps_of_blocks(patch.rows, point.resolution, point.mp1_height);
}

double seconds_of(ShotPipeline& pipeline, std::uint32_t shooter) {
    const auto start = std::chrono::steady_clock::now();
    shoot_from(pipeline, shooter);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Each shooter's fastest of several rounds, so that what else runs on the machine counts less.
class ShotTimes {
  public:
    explicit ShotTimes(std::vector<double> first_round) : seconds_(std::move(first_round)) {}

    void repeat(ShotPipeline& pipeline, const std::vector<std::uint32_t>& shooters) {
        double spent = sum();
        for (int round = 1; round < kMostRounds && spent < kSecondsForRounds; ++round)
            for (std::size_t i = 0; i < shooters.size(); ++i) {
                const double seconds = seconds_of(pipeline, shooters[i]);
                spent += seconds;
                seconds_[i] = std::min(seconds_[i], seconds);
            }
    }
    double least() const { return *std::min_element(seconds_.begin(), seconds_.end()); }
    double median() const {
        std::vector<double> sorted = seconds_;
        std::sort(sorted.begin(), sorted.end());
        const std::size_t half = sorted.size() / 2;
        return sorted.size() % 2 != 0 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
    }

  private:
    double sum() const { return std::accumulate(seconds_.begin(), seconds_.end(), 0.0); }

    std::vector<double> seconds_;
};

void add_stacks(SweepMeasurement& sum, const std::vector<std::uint32_t>& levels,
                std::uint32_t pe_count) {
    sum.stack_levels += static_cast<double>(levels.size());
    if (sum.stack_fill.size() < levels.size()) sum.stack_fill.resize(levels.size());
    for (std::size_t level = 0; level < levels.size(); ++level)
        sum.stack_fill[level] += static_cast<double>(levels[level]) / pe_count;
}

void add_areas(SweepMeasurement& sum, const ShotAreas& shot) {
    sum.visible += static_cast<double>(shot.visible);
    sum.projected += static_cast<double>(shot.projected);
    sum.areas += static_cast<double>(shot.areas);
    sum.tile_patches += static_cast<double>(shot.tile_patches);
    sum.useful += static_cast<double>(shot.useful);
}

void add_mp1(mp1map::Mp1Seconds& sum, const mp1map::Mp1Seconds& shot) {
    sum.cull += shot.cull;
    sum.set_up += shot.set_up;
    sum.diffusion += shot.diffusion;
    sum.inside_tests += shot.inside_tests;
    sum.depth += shot.depth;
    sum.accumulate += shot.accumulate;
    sum.update += shot.update;
    sum.choose += shot.choose;
}

void divide(SweepMeasurement& sums, double shots) {
    auto& mp1 = sums.mp1;
    for (double* const sum :
         {&sums.visible, &sums.projected, &sums.stack_levels, &sums.tile_patches, &sums.areas,
          &sums.useful, &mp1.cull, &mp1.set_up, &mp1.diffusion, &mp1.inside_tests, &mp1.depth,
          &mp1.accumulate, &mp1.update, &mp1.choose})
        *sum /= shots;
    for (double& fill : sums.stack_fill) fill /= shots;
}

// Timed kernels in a run of their own: events would count into the time of a shot.
std::map<std::string, double> kernel_seconds(const SweepScene& scene, PipelineSettings settings,
                                             const mp1map::Device& device) {
    settings.timed = true;
    auto pipeline = pipeline_for(scene, settings, device);
    for (const std::uint32_t shooter : scene.shooters()) shoot_from(pipeline, shooter);
    std::map<std::string, double> result;
    for (const auto& [name, cost] : pipeline.acu().kernel_seconds())
        result[name] = cost.first / static_cast<double>(cost.second);
    return result;
}

std::vector<std::int32_t> owners_of(ShotPipeline& pipeline, std::uint32_t shooter) {
    shoot_from(pipeline, shooter);
    return pipeline.owners();
}

}  // namespace

SweepScene::SweepScene(PatchArrays patches, std::uint32_t shots) : patches_(std::move(patches)) {
    for (std::uint64_t i = 0; i < shots; ++i)
        shooters_.push_back(static_cast<std::uint32_t>(i * patches_.patch_count / shots));
}

const std::vector<PlaneView>& SweepScene::views(std::uint32_t resolution,
                                                const mp1map::Device& device) {
    auto& views = views_[resolution];
    if (!views.empty()) return views;
    PipelineSettings settings;
    settings.resolution = resolution;
    settings.count_activity = true;
    auto pipeline = pipeline_for(*this, settings, device);
    for (const std::uint32_t shooter : shooters_) {
        shoot_from(pipeline, shooter);
        views.push_back(view_of(pipeline));
    }
    return views;
}

ShotAreas count_areas(const PlaneView& view, const SweepPoint& point,
                      const mp1map::PeArray& array) {
    ShotAreas shot;
    shot.visible = view.visible.size();
    shot.useful = view.useful_proxels;
    for (const auto& patch : view.visible) {
        const auto tiles =
            mp1map::areas_touched(patch.columns, patch.rows, array.tile_width, array.tile_height);
        if (tiles == 0) continue;
        ++shot.projected;
        shot.tile_patches += tiles;
        shot.areas += areas_visited(patch, point);
    }
    return shot;
}

std::vector<std::uint32_t> stack_levels(const PlaneView& view, std::uint32_t pe_count) {
    std::vector<std::uint32_t> height(pe_count), levels;
    for (const auto& rectangle : view.visible) {
        const std::uint32_t level = height[rectangle.patch % pe_count]++;
        if (level == levels.size()) levels.push_back(0);
        ++levels[level];
    }
    return levels;
}

mp1map::ShotCounts mp1_counts(const ShotAreas& shot, const SweepPoint& point,
                              const PatchArrays& patches) {
    mp1map::ShotCounts counts;
    counts.patches = patches.patch_count;
    counts.patches_visible = shot.visible;
    counts.edges_per_patch = patches.corner_count;
    counts.patches_projected = shot.projected;
    counts.areas_visited = shot.areas;
    counts.proxels_inside = shot.useful;
    counts.plane_areas =
        mp1map::areas_of_plane(point.resolution, point.mp1_width, point.mp1_height);
    return counts;
}

SweepMeasurement measure(SweepScene& scene, const SweepPoint& point, const mp1map::Device& device) {
    const auto& views = scene.views(point.resolution, device);
    auto pipeline = pipeline_for(scene, settings_of(point), device);
    for (std::size_t i = 0; i < std::min(kWarmUpShots, views.size()); ++i)
        shoot_from(pipeline, scene.shooters()[i]);

    SweepMeasurement result;
    result.pe_array = pipeline.pe_array();
    const mp1map::Mp1 mp1{.width = point.mp1_width, .height = point.mp1_height};
    std::vector<double> seconds;
    for (std::size_t i = 0; i < views.size(); ++i) {
        seconds.push_back(seconds_of(pipeline, scene.shooters()[i]));
        const std::uint32_t pes = point.mp1_width * point.mp1_height;
        add_stacks(result, stack_levels(views[i], pes), pes);
        const auto areas = count_areas(views[i], point, result.pe_array);
        add_areas(result, areas);
        add_mp1(result.mp1, mp1map::seconds(mp1_counts(areas, point, scene.patches()), mp1));
    }
    divide(result, static_cast<double>(views.size()));
    ShotTimes times(std::move(seconds));
    times.repeat(pipeline, scene.shooters());
    result.seconds_min = times.least();
    result.seconds_median = times.median();
    result.kernel_seconds = kernel_seconds(scene, settings_of(point), device);
    return result;
}

double wrong_per_million(const SweepScene& scene, SweepPoint point, const mp1map::Device& device) {
    auto settings = settings_of(point);
    settings.keep_owners = true;
    auto tried = pipeline_for(scene, settings, device);
    settings.variants.incremental = false;
    auto direct = pipeline_for(scene, settings, device);
    std::uint64_t wrong = 0;
    for (const std::uint32_t shooter : scene.shooters()) {
        const auto owners = owners_of(tried, shooter), right = owners_of(direct, shooter);
        for (std::size_t i = 0; i < right.size(); ++i) wrong += owners[i] != right[i];
    }
    const auto proxels = disk_proxel_count(point.resolution) * scene.shooters().size();
    return 1e6 * static_cast<double>(wrong) / static_cast<double>(proxels);
}

}  // namespace hemirad
