#include "solver/shot_pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>

#include "errors.h"
#include "solver/kernel_source.h"

namespace hemirad {
namespace {

static_assert(kReducePes <= mp1map::kLeastWorkGroup);
// A visible patch touches two or three tiles; where more do, the lists are enlarged on demand.
constexpr std::uint64_t kListEntriesPerPatch = 4, kLeastListEntries = 65536;
constexpr std::uint32_t kMostListEntries = std::numeric_limits<std::int32_t>::max();

std::uint32_t quotient_up(std::uint64_t value, std::uint64_t divisor) {
    return static_cast<std::uint32_t>((value + divisor - 1) / divisor);
}

std::uint32_t count_tiles(std::uint32_t resolution, const mp1map::PeArray& array) {
    return quotient_up(resolution, array.tile_width) * quotient_up(resolution, array.tile_height);
}

// PEs of prefix_sum, an array a station; a GPU's are slow one by one.
std::uint32_t prefix_pes(const mp1map::PeArray& array) {
    constexpr std::uint32_t kLeast = mp1map::kLeastWorkGroup;
    return array.is_on_cpu ? kLeast : std::max(kLeast, array.pe_count());
}

// Patches a PE manages: whole clusters.
std::uint32_t stack_depth(std::uint32_t stride, std::uint32_t stack_count) {
    return quotient_up(quotient_up(stride, stack_count), kClusterPatches) * kClusterPatches;
}

std::uint64_t list_capacity(std::uint64_t stride) {
    return std::max(kLeastListEntries, kListEntriesPerPatch * stride);
}

// What lies behind the last unit of kept rows is read as well, a vector at a time.
constexpr std::uint64_t kBehindRows = 16;  // words

// Units of kept rows (kernels/rows.clh): as many as the bytes hold, at most those of rows without
// zeros, one for each shooter, and of what is left of PEs' extents.
std::uint32_t row_units(std::uint64_t shooters, std::uint64_t stride, std::uint64_t row_bytes,
                        std::uint64_t pe_count) {
    constexpr std::uint64_t kBlockUnits = (1 + kRowBitWords + kReduceBlock) / kRowUnit + 1;
    const std::uint64_t all =
        (shooters * (stride / kReduceBlock) * kBlockUnits / (kExtentUnits - 2 * kBlockUnits) +
         2 * pe_count) *
        kExtentUnits;
    const std::uint64_t words = std::max(std::min(row_bytes, kMostRowBytes) / 4, kBehindRows);
    return static_cast<std::uint32_t>(std::min((words - kBehindRows) / kRowUnit, all));
}

std::string definition(const char* name, std::uint64_t value) {
    return std::string(" -D") + name + "=" + std::to_string(value);
}

std::string flag(const char* name, bool set) { return set ? std::string(" -D") + name : ""; }

// Sub-proxel patches ask for the owner of the proxel they lie in.
bool needs_owners(const PipelineSettings& settings) {
    return settings.keep_owners || settings.form_factor == FormFactorMode::analytic;
}

// Groups of a launch for each that works on the flux, see kernels/progress.clh.
std::uint32_t flux_spacing(const mp1map::PeArray& array) { return array.is_on_cpu ? 4 : 1; }

std::string build_options(const mp1map::PeArray& array, std::uint32_t resolution,
                          std::uint32_t corner_count, std::size_t bands, bool two_levels,
                          const PipelineSettings& settings) {
    return definition("LANES", array.lanes) + definition("PE_WIDTH", array.width) +
           definition("PE_HEIGHT", array.height) + definition("TILE_WIDTH", array.tile_width) +
           definition("TILE_HEIGHT", array.tile_height) + definition("RESOLUTION", resolution) +
           definition("CORNERS", corner_count) + definition("BANDS", bands) +
           definition("PREFIX_PES", prefix_pes(array)) + definition("REDUCE_PES", kReducePes) +
           definition("BROADCAST_PATCHES", array.broadcast_patches()) +
           definition("SALVO", settings.salvo) + definition("FLUX_SPACING", flux_spacing(array)) +
           flag("TWO_LEVELS", two_levels) +
           flag("LAYOUT_BLOCK", array.layout == mp1map::Layout::block) +
           flag("EVALUATE_INCREMENTAL", settings.variants.incremental) +
           flag("DISTANCE_CONSTANT", settings.variants.constant_distance) +
           flag("ACCUMULATE_XNET", settings.variants.xnet) +
           flag("COUNT_ACTIVITY", settings.count_activity) +
           flag("FORM_FACTOR_ANALYTIC", settings.form_factor == FormFactorMode::analytic) +
           flag("KEEP_OWNERS", needs_owners(settings));
}

std::vector<std::int32_t> samples_of(const PipelineSettings& settings, std::uint32_t stride) {
    if (settings.patch_samples.empty())
        return std::vector(stride, static_cast<std::int32_t>(settings.shooter_samples));
    std::vector<std::int32_t> samples = settings.patch_samples;
    samples.resize(stride, 1);
    return samples;
}

// Counts are signed 32-bit integers on the device.
void require_countable(std::uint64_t disk_proxels, std::uint32_t resolution,
                       const std::vector<std::int32_t>& samples) {
    const std::uint64_t most = static_cast<std::uint64_t>(*std::ranges::max_element(samples));
    const std::uint64_t proxels = disk_proxels * most * most;
    if (proxels > std::numeric_limits<std::int32_t>::max())
        throw InputError("--resolution " + std::to_string(resolution) + " with --shooter-samples " +
                         std::to_string(most) + ": " + std::to_string(proxels) +
                         " proxels a shot; at most 2147483647 can be counted");
}

device::Shot first_shot() {
    device::Shot shot{};
    shot.shooter = -1;
    shot.status = kRunning;
    shot.unshot_fraction = 1;
    shot.shot_limit = shot.most_shots = std::numeric_limits<std::uint32_t>::max();
    shot.least_surplus = std::numeric_limits<std::int32_t>::max();
    shot.most_surplus = std::numeric_limits<std::int32_t>::min();
    return shot;
}

// Kernels index the patch database, and what a salvo's stations hold of it, with signed 32-bit
// integers.
void require_addressable(const PatchArrays& patches, std::uint32_t salvo, std::uint64_t slots,
                         std::uint64_t lists) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
    const std::uint64_t stride = patches.stride;
    if (3 * patches.corner_count * stride > kMost)
        throw InputError(std::to_string(patches.patch_count) +
                         " patches are more than can be addressed: raise --patch-size");
    const std::uint64_t largest =
        std::max({slots, lists, list_capacity(stride), kFactorKinds * stride, stride + kCountsGap});
    if (salvo * largest > kMost)
        throw InputError("--salvo " + std::to_string(salvo) + ": " +
                         std::to_string(salvo * largest) +
                         " elements of a buffer are more than can be addressed");
}

bool is_finite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

}  // namespace

std::vector<std::string> kernel_names(FormFactorMode mode) {
    std::vector<std::string> names = {"init_plane",        "aim_hemisphere", "cull_patches",
                                      "set_up_projection", "count_areas",    "prepare_patches",
                                      "prefix_sum",        "bin_areas",      "project_patches"};
    if (mode == FormFactorMode::analytic)
        for (const char* name :
             {"estimate_form_factors", "correct_near_pairs", "add_up_factors", "spread_residual"})
            names.emplace_back(name);
    names.insert(names.end(),
                 {"update_radiosity", "update_unshot", "receive_flux", "choose_shooter"});
    return names;
}

std::vector<std::string> gather_kernel_names(FormFactorMode mode) {
    std::vector<std::string> names = kernel_names(mode);
    std::erase_if(names, [](const std::string& name) {
        return name == "aim_hemisphere" || name == "correct_near_pairs" ||
               name == "update_radiosity" || name == "update_unshot" || name == "receive_flux" ||
               name == "choose_shooter";
    });
    names.insert(names.end(), {"aim_points", "gather_irradiance", "add_up_irradiance"});
    return names;
}

std::vector<std::string> launched_kernels(FormFactorMode mode) {
    std::vector<std::string> names = kernel_names(mode);
    std::erase_if(names, [](const std::string& name) {
        return name == "init_plane" || name == "cull_patches" || name == "set_up_projection" ||
               name == "count_areas" || name == "update_radiosity" || name == "update_unshot";
    });
    return names;
}

PatchLight even_light(const PatchArrays& patches, float reflectance) {
    PatchLight light;
    light.emitted.assign(patches.stride, 0.0f);
    light.reflectance.assign(patches.stride, 0.0f);
    std::fill_n(light.emitted.begin(), patches.patch_count,
                1.0f / static_cast<float>(patches.patch_count));
    std::fill_n(light.reflectance.begin(), patches.patch_count, reflectance);
    light.band_weight = {1.0f};
    return light;
}

std::uint64_t disk_proxel_count(std::uint32_t resolution) {
    const std::int64_t n = resolution;
    std::uint64_t count = 0;
    for (std::int64_t b = 1 - n; b < n; b += 2) {
        // Odd or even as n is not: columns a with a^2 < n^2 - b^2.
        std::int64_t half =
            static_cast<std::int64_t>(std::sqrt(static_cast<double>(n * n - b * b)));
        while (half * half >= n * n - b * b) --half;
        while ((half + 1) * (half + 1) < n * n - b * b) ++half;
        if ((half - (n - 1)) % 2 != 0) --half;
        if (half >= 0) count += static_cast<std::uint64_t>(half + 1);
    }
    return count;
}

std::uint64_t estimated_device_bytes(std::uint32_t patches, std::uint32_t shooters,
                                     std::uint32_t corner_count, std::size_t bands,
                                     std::uint32_t resolution, FormFactorMode mode,
                                     std::uint64_t row_bytes, const mp1map::PeArray& array,
                                     std::uint32_t salvo, bool count_shots) {
    const std::uint64_t stride = std::uint64_t{quotient_up(patches, kReduceBlock)} * kReduceBlock;
    const std::uint64_t stacks = std::uint64_t{array.array_count} * array.pe_count();
    const std::uint64_t slots = stacks * stack_depth(static_cast<std::uint32_t>(stride),
                                                     static_cast<std::uint32_t>(stacks));
    const std::uint64_t tiles = count_tiles(resolution, array);
    const std::uint64_t shooter_stride =
        std::uint64_t{quotient_up(shooters, kReduceBlock)} * kReduceBlock;
    const std::uint64_t geometry = stride * (4 * (3 * corner_count + 6) + 1) +
                                   stride / kClusterPatches * sizeof(device::Cluster) +
                                   4 * shooter_stride;
    const std::uint64_t radiosity = 4 * bands * (2 * stride + 2 * shooter_stride);
    const std::uint64_t groups =
        shooters < patches ? shooter_stride * 4 * (3 * corner_count + 6) : 0;
    const std::uint64_t projection =
        slots * (sizeof(device::Projection) + sizeof(device::Rectangle)) +
        slots / array.lanes * sizeof(device::Level) + stacks * 8 + 4 * stride;
    const std::uint64_t lists = 4 * (list_capacity(stride) + tiles * (stacks + 1));
    const std::uint64_t plane = 4 * tiles * array.tile_width * array.tile_height;
    const std::uint64_t reduction =
        shooter_stride / kReduceBlock * (sizeof(device::BlockSummary) + 4 * bands);
    const std::uint64_t analytic =
        mode == FormFactorMode::analytic ? stride * 4 * (kFactorKinds + 2) + plane : 0;
    const std::uint64_t shot_rows =
        4 * (salvo + 1) * (shooters < patches ? stride : stacks * kReduceBlock);
    const std::uint64_t rows =
        4 * (std::uint64_t{kRowUnit} * row_units(shooters, stride, row_bytes, stacks) +
             kBehindRows + 2 * shooter_stride) +
        stacks * sizeof(device::Extent) + shot_rows;
    const std::uint64_t shots = count_shots ? 4 * shooter_stride : 0;
    return geometry + radiosity + groups + plane + reduction + rows + shots +
           salvo * (projection + lists + analytic);
}

// A word and two more a block of patches, and one for each patch that is seen; a twenty-fifth is
// lost where PEs' extents end.
std::uint64_t estimated_row_bytes(double seen_patches, std::uint64_t patches) {
    const double blocks = static_cast<double>(patches) / kReduceBlock;
    return static_cast<std::uint64_t>(1.04 * 4 * (seen_patches + (1 + kRowBitWords) * blocks));
}

ShotPipeline::ShotPipeline(const PatchArrays& patches, const PatchLight& light,
                           const PipelineSettings& settings, const mp1map::Device& device,
                           const ShooterArrays& shooters)
    : array_(mp1map::fit_pe_array(device.summary(), settings.pe_array)),
      acu_(device, settings.timed),
      resolution_(settings.resolution),
      stride_(patches.stride),
      shooter_stride_(shooters.first_patch.empty() ? stride_ : shooters.polygons.stride),
      salvo_(settings.salvo),
      band_count_(light.band_count),
      tile_count_(count_tiles(resolution_, array_)),
      stack_count_(array_.array_count * array_.pe_count()),
      depth_(stack_depth(stride_, stack_count_)),
      disk_proxels_(disk_proxel_count(resolution_)),
      mode_(settings.form_factor),
      two_levels_(!shooters.first_patch.empty()),
      apart_(settings.apart),
      tolerance_(static_cast<float>(settings.tolerance)),
      samples_(samples_of(settings, shooter_stride_)) {
    require_addressable(patches, salvo_, std::uint64_t{stack_count_} * depth_,
                        tile_count_ * std::max<std::uint64_t>(
                                          stack_count_, array_.tile_width * array_.tile_height));
    require_countable(disk_proxels_, resolution_, samples_);
    build_kernels(device, settings, patches.corner_count);
    shot_ = acu_.plural(std::vector(member_count(), first_shot()));
    clusters_ = acu_.plural(clusters_of(patches));
    corners_ = acu_.plural(patches.corners);
    normals_ = acu_.plural(patches.normals);
    planes_ = acu_.plural(patches.planes);
    rooms_ = acu_.plural(patches.rooms);
    rims_ = acu_.plural(patches.rims);
    load_shooters(patches, shooters);
    roots_ = acu_.plural<float>(std::size_t{tile_count_} * array_.tile_width * array_.tile_height);
    const std::size_t stacks = std::size_t{salvo_} * stack_count_;
    stack_ = acu_.plural<device::Level>(stacks * (depth_ / array_.lanes));
    stack_height_ = acu_.plural<std::int32_t>(stacks);
    projection_count_ = acu_.plural<std::int32_t>(stacks);
    projections_ = acu_.plural<device::Projection>(stacks * depth_);
    rectangles_ = acu_.plural<device::Rectangle>(projections_.size());
    places_ = acu_.plural<std::int32_t>(stacks * tile_count_);
    list_end_ = acu_.plural<std::int32_t>(std::size_t{salvo_} * tile_count_);
    lists_ = acu_.plural<std::int32_t>(salvo_ * list_capacity(stride_));
    proxel_count_ = acu_.plural<std::int32_t>(std::size_t{salvo_} * (stride_ + kCountsGap));
    owners_ = acu_.plural<std::int32_t>(needs_owners(settings) ? salvo_ * roots_.size() : 0);
    load_near_pairs(settings.near_pairs);
    activity_ = acu_.plural<std::uint32_t>(kActivityCounters);

    const std::size_t states = band_count_ * stride_;
    const std::size_t blocks = shooter_stride_ / kReduceBlock;
    received_ = acu_.plural<float>(states);
    received_rest_ = acu_.plural<float>(states);
    unshot_ = acu_.plural(light.emitted);
    reflectance_ = acu_.plural(light.reflectance);
    band_weight_ = acu_.plural(light.band_weight);
    shot_flux_ = acu_.plural<float>(salvo_ * band_count_);
    escaped_ = acu_.plural<float>(2 * band_count_);
    const auto shooting = two_levels_ ? shooters.polygons.patch_count : patches.patch_count;
    const std::uint32_t units = row_units(shooting, stride_, settings.row_bytes, stack_count_);
    rows_ = acu_.unset_plural<std::uint32_t>(std::size_t{kRowUnit} * units + kBehindRows);
    row_pool_ = acu_.plural(std::vector{device::RowPool{1, units}});
    row_extents_ = acu_.plural<device::Extent>(stack_count_);
    row_of_ = acu_.plural<std::int32_t>(shooter_stride_);
    row_escaped_ = acu_.plural<float>(shooter_stride_);
    shot_rows_ = acu_.plural<float>(
        (salvo_ + 1) * std::size_t{apart_ || two_levels_ ? stride_ : stack_count_ * kReduceBlock});
    shots_of_ = acu_.plural<std::uint32_t>(settings.count_shots ? shooter_stride_ : 0);
    summaries_ = acu_.plural<device::BlockSummary>(blocks);
    block_unshot_ = acu_.plural<float>(blocks * band_count_);
}

void ShotPipeline::build_kernels(const mp1map::Device& device, const PipelineSettings& settings,
                                 std::uint32_t corner_count) {
    const auto start = std::chrono::steady_clock::now();
    const std::string options =
        build_options(array_, resolution_, corner_count, band_count_, two_levels_, settings);
    std::string source;
    const auto names = settings.gathers ? gather_kernel_names(mode_) : kernel_names(mode_);
    for (const auto& name : names) source += kernel_source(name, settings.kernels_dir);
    kernels_ = mp1map::build_kernels(device, names, source, options);
    build_seconds_ =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void ShotPipeline::load_shooters(const PatchArrays& patches, const ShooterArrays& shooters) {
    const bool own = shooters.first_patch.empty();
    shooter_corners_ = own ? corners_ : acu_.plural(shooters.polygons.corners);
    shooter_normals_ = own ? normals_ : acu_.plural(shooters.polygons.normals);
    shooter_reached_ = acu_.plural(own ? patches.reached : shooters.polygons.reached);
    shooter_planes_ = own ? planes_ : acu_.plural(shooters.polygons.planes);
    first_patch_ = acu_.plural(shooters.first_patch);
    shooter_samples_ = acu_.plural(samples_);
}

void ShotPipeline::load_near_pairs(const NearPairs& pairs) {
    const std::size_t used = mode_ == FormFactorMode::analytic ? stride_ : 0;
    covered_count_ = acu_.plural<std::int32_t>(salvo_ * used);
    factors_ = acu_.plural<float>(salvo_ * kFactorKinds * used);
    factor_block_sums_ = acu_.plural<float>(salvo_ * 2 * used / kReduceBlock);
    std::vector<std::int32_t> begin = pairs.begin;
    begin.resize(used == 0 ? 1 : shooter_stride_ + 1, begin.empty() ? 0 : begin.back());
    near_begin_ = acu_.plural(begin);
    near_patch_ = acu_.plural(pairs.patch);
    near_factor_ = acu_.plural(pairs.form_factor);
}

void ShotPipeline::load(const PatchArrays& patches) {
    const auto clusters = clusters_of(patches);
    acu_.load(clusters_, std::span(clusters));
    acu_.load(corners_, std::span(patches.corners));
    acu_.load(normals_, std::span(patches.normals));
    acu_.load(planes_, std::span(patches.planes));
    acu_.load(rooms_, std::span(patches.rooms));
    acu_.load(shooter_reached_, std::span(patches.reached));
    acu_.load(rims_, std::span(patches.rims));
}

mp1map::Kernel& ShotPipeline::kernel(const std::string& name) { return kernels_.at(name); }

mp1map::Grid ShotPipeline::flux_grid() const {
    return {array_.array_count * flux_spacing(array_), array_.pe_count()};
}

mp1map::Grid ShotPipeline::salvo_stack_grid() const {
    return {std::size_t{salvo_} * array_.array_count, array_.pe_count()};
}

mp1map::Grid ShotPipeline::salvo_tile_grid() const {
    return {std::size_t{salvo_} * tile_count_, array_.pe_count()};
}

void ShotPipeline::init_plane() {
    acu_.issue(kernel("init_plane"), {tile_count_, array_.pe_count()}, roots_);
}

void ShotPipeline::aim_hemisphere() {
    acu_.issue(kernel("aim_hemisphere"), {member_count(), 1}, shot_, shooter_corners_,
               shooter_normals_, shooter_planes_, shooter_reached_, std::int32_t(shooter_stride_),
               shooter_samples_);
}

void ShotPipeline::cull_patches() {
    acu_.issue(kernel("cull_patches"), salvo_stack_grid(), shot_, clusters_, corners_, normals_,
               planes_, rooms_, std::int32_t(stride_), std::int32_t(depth_), stack_, stack_height_);
}

void ShotPipeline::set_up_projection() {
    acu_.issue(kernel("set_up_projection"), salvo_stack_grid(), shot_, corners_, normals_,
               std::int32_t(stride_), std::int32_t(depth_), stack_, stack_height_, projections_,
               rectangles_, projection_count_);
}

void ShotPipeline::count_areas() {
    acu_.issue(kernel("count_areas"), salvo_stack_grid(), shot_, rectangles_, projection_count_,
               std::int32_t(depth_), places_);
}

// A launch's threads have to be woken, and wait for the slowest of them.
void ShotPipeline::prepare_patches() {
    if (apart_) {
        cull_patches();
        set_up_projection();
        count_areas();
        return;
    }
    acu_.issue(kernel("prepare_patches"), salvo_stack_grid(), shot_, clusters_, corners_, normals_,
               planes_, rooms_, std::int32_t(stride_), std::int32_t(depth_), stack_, stack_height_,
               projections_, rectangles_, projection_count_, places_);
}

void ShotPipeline::prefix_sum() {
    acu_.issue(kernel("prefix_sum"), {salvo_, prefix_pes(array_)}, shot_, places_,
               std::int32_t(stack_count_), list_end_, std::uint32_t(lists_.size() / salvo_));
}

void ShotPipeline::bin_areas() {
    acu_.issue(kernel("bin_areas"), salvo_stack_grid(), shot_, rectangles_, projection_count_,
               std::int32_t(depth_), places_, lists_);
}

void ShotPipeline::project_patches() {
    acu_.issue(kernel("project_patches"), salvo_tile_grid(), shot_, roots_, projections_,
               rectangles_, list_end_, lists_, std::uint32_t(lists_.size() / salvo_),
               std::int32_t(escaped_owner()), proxel_count_, covered_count_, owners_, activity_);
}

void ShotPipeline::estimate_form_factors() {
    acu_.issue(kernel("estimate_form_factors"), salvo_stack_grid(), shot_, corners_, normals_,
               planes_, rims_, std::int32_t(stride_), std::int32_t(depth_), stack_, stack_height_,
               owners_, proxel_count_, covered_count_, factors_);
}

void ShotPipeline::correct_near_pairs() {
    acu_.issue(kernel("correct_near_pairs"), {salvo_, kReducePes}, shot_, near_begin_, near_patch_,
               near_factor_, std::int32_t(stride_), factors_);
}

void ShotPipeline::add_up_factors() {
    acu_.issue(kernel("add_up_factors"), salvo_stack_grid(), shot_, factors_, std::int32_t(stride_),
               factor_block_sums_);
}

void ShotPipeline::spread_residual() {
    acu_.issue(kernel("spread_residual"), {salvo_, kReducePes}, shot_, factor_block_sums_,
               std::int32_t(stride_ / kReduceBlock), proxel_count_, std::int32_t(stride_),
               std::int32_t(disk_proxels_));
}

void ShotPipeline::update_radiosity() {
    acu_.issue(kernel("update_radiosity"), flux_grid(), shot_, shot_flux_, proxel_count_,
               std::int32_t(disk_proxels_), factors_, std::int32_t(stride_), rows_, row_pool_,
               row_extents_, shot_rows_, received_, received_rest_);
}

void ShotPipeline::update_unshot() {
    acu_.issue(kernel("update_unshot"), flux_grid(), shot_, shot_flux_, shot_rows_,
               std::int32_t(stride_), first_patch_, std::int32_t(shooter_stride_), unshot_,
               reflectance_, band_weight_, summaries_, block_unshot_);
}

// Of two levels, a shooter's patches are not always those of the PE that adds it up.
void ShotPipeline::receive_flux() {
    if (apart_ || two_levels_) {
        update_radiosity();
        update_unshot();
        return;
    }
    acu_.issue(kernel("receive_flux"), flux_grid(), shot_, shot_flux_, proxel_count_,
               std::int32_t(disk_proxels_), factors_, std::int32_t(stride_), rows_, row_pool_,
               row_extents_, shot_rows_, received_, received_rest_, unshot_, reflectance_,
               band_weight_, summaries_, block_unshot_);
}

void ShotPipeline::choose_shooter() {
    acu_.issue(kernel("choose_shooter"), {1, kReducePes}, shot_, summaries_, block_unshot_,
               std::int32_t(summaries_.size()), unshot_, std::int32_t(shooter_stride_),
               band_weight_, tolerance_, std::int32_t(disk_proxels_), proxel_count_,
               std::int32_t(stride_), escaped_, shot_flux_, row_pool_, row_of_, row_escaped_,
               std::int32_t(shots_of_.size() > 0), shots_of_);
}

void ShotPipeline::aim_points(std::uint32_t first, std::uint32_t end) {
    acu_.issue(kernel("aim_points"), {member_count(), 1}, shot_, points_, std::int32_t(first),
               std::int32_t(end));
}

void ShotPipeline::gather_irradiance() {
    acu_.issue(kernel("gather_irradiance"), salvo_stack_grid(), shot_, proxel_count_,
               std::int32_t(disk_proxels_), factors_, std::int32_t(stride_), radiosity_,
               std::int32_t(gathered_bands()), block_irradiance_);
}

void ShotPipeline::add_up_irradiance() {
    acu_.issue(kernel("add_up_irradiance"), {std::size_t{salvo_} * gathered_bands(), kReducePes},
               shot_, block_irradiance_, std::int32_t(stride_ / kReduceBlock),
               std::int32_t(gathered_bands()), proxel_count_, std::int32_t(stride_), gathered_);
}

void ShotPipeline::load_radiosity(const std::vector<float>& radiosity) {
    radiosity_ = acu_.plural(radiosity);
    block_irradiance_ = acu_.plural<float>(salvo_ * radiosity.size() / kReduceBlock);
}

void ShotPipeline::load_points(const std::vector<device::GatherPoint>& points) {
    points_ = acu_.plural(points);
    gathered_ = acu_.plural<float>(points.size() * gathered_bands());
}

device::Shot ShotPipeline::shot() {
    const auto salvo = acu_.unload(shot_);
    device::Shot shot = salvo.front();
    for (const device::Shot& member : salvo) {
        if (member.status != kBinsFull) continue;
        shot.status = kBinsFull;
        shot.bin_entries = std::max(shot.bin_entries, member.bin_entries);
    }
    return shot;
}

void ShotPipeline::set_shot(const device::Shot& shot) {
    acu_.load(shot_, std::span<const device::Shot>(&shot, 1));
}

void ShotPipeline::set_shooter(std::uint32_t shooter, std::uint32_t part) {
    static_assert(offsetof(device::Shot, origin) == 4 * kNextShooterWords);
    device::Shot next{};
    next.shooter = static_cast<std::int32_t>(shooter);
    next.plane = -1;
    next.part = part;
    next.part_count = part_count(shooter);
    next.status = kRunning;
    acu_.load_words<kNextShooterWords>(shot_, next);
}

void ShotPipeline::set_shot_limit(std::uint64_t shots, std::uint64_t most) {
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    auto salvo = acu_.unload(shot_);
    device::Shot& books = salvo.front();
    books.shot_limit = static_cast<std::uint32_t>(std::min(shots, kMost));
    books.most_shots = static_cast<std::uint32_t>(std::min(most, kMost));
    if (books.status == kPaused && books.shots < books.shot_limit)
        for (device::Shot& shot : salvo) shot.status = kRunning;
    acu_.load(shot_, std::span<const device::Shot>(salvo));
}

std::uint32_t ShotPipeline::part_count(std::uint32_t shooter) const {
    return static_cast<std::uint32_t>(samples_[shooter] * samples_[shooter]);
}

std::uint32_t ShotPipeline::most_parts() const {
    const auto most = static_cast<std::uint32_t>(*std::ranges::max_element(samples_));
    return most * most;
}

void ShotPipeline::enlarge_lists() {
    const std::uint32_t entries = shot().bin_entries;
    const std::size_t most = kMostListEntries / salvo_;
    if (entries > most)
        throw mp1map::DeviceError("a shot needs lists of " + std::to_string(entries) +
                                  " patches; at most " + std::to_string(most) +
                                  " can be addressed: raise --patch-size or lower --resolution");
    lists_ = acu_.plural<std::int32_t>(salvo_ * std::min(std::size_t{entries} * 3 / 2, most));
    clear_counts();
    auto salvo = acu_.unload(shot_);
    for (device::Shot& shot : salvo) {
        shot.status = kRunning;
        shot.part = shot.row_known != 0 ? 1 : 0;
        shot.is_done = 0;
    }
    acu_.load(shot_, std::span<const device::Shot>(salvo));
}

SolveState ShotPipeline::state() {
    const device::Shot books = acu_.unload(shot_).front();
    return {books.shots,
            books.repeated_shots,
            books.least_surplus,
            books.most_surplus,
            acu_.unload(unshot_),
            acu_.unload(received_),
            acu_.unload(received_rest_),
            acu_.unload(escaped_),
            shots_of()};
}

// Directories of rows that nobody has written are the last that were taken: choose_shooter promises
// them, which comes behind what fills them.
void ShotPipeline::take_back_promised_rows() {
    auto pool = acu_.unload(row_pool_);
    for (const device::Shot& shot : acu_.unload(shot_))
        if (shot.shooter >= 0 && shot.row_known == 0 && shot.row != 0)
            pool.front().taken = std::min(pool.front().taken, static_cast<std::uint32_t>(shot.row));
    acu_.load(row_pool_, std::span<const device::RowPool>(pool));
}

void ShotPipeline::set_state(const SolveState& state) {
    if (state.unshot.size() != unshot_.size() || state.received.size() != received_.size() ||
        state.received_rest.size() != received_.size() || state.escaped.size() != escaped_.size() ||
        state.shots_of.size() != shots_of_.size())
        throw InputError("the state of another solve");
    if (state.shots > std::numeric_limits<std::uint32_t>::max() || !is_finite(state.unshot) ||
        !is_finite(state.received) || !is_finite(state.received_rest) || !is_finite(state.escaped))
        throw InputError("no state that a solve comes to");
    take_back_promised_rows();
    auto salvo = std::vector(member_count(), first_shot());
    device::Shot& books = salvo.front();
    books.rows_kept = shot().rows_kept;
    books.shots = static_cast<std::uint32_t>(state.shots);
    books.repeated_shots = static_cast<std::uint32_t>(state.repeated_shots);
    books.least_surplus = state.least_surplus;
    books.most_surplus = state.most_surplus;
    acu_.load(shot_, std::span<const device::Shot>(salvo));
    acu_.load(unshot_, std::span(state.unshot));
    acu_.load(received_, std::span(state.received));
    acu_.load(received_rest_, std::span(state.received_rest));
    acu_.load(escaped_, std::span(state.escaped));
    acu_.load(shots_of_, std::span(state.shots_of));
}

std::vector<double> ShotPipeline::received() {
    const auto sums = acu_.unload(received_), rests = acu_.unload(received_rest_);
    std::vector<double> result(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) result[i] = double{sums[i]} + rests[i];
    return result;
}

std::vector<float> ShotPipeline::unshot() { return acu_.unload(unshot_); }

std::vector<double> ShotPipeline::escaped() {
    const auto sums = acu_.unload(escaped_);
    std::vector<double> result(band_count_);
    for (std::size_t band = 0; band < band_count_; ++band)
        result[band] = double{sums[band]} + sums[band_count_ + band];
    return result;
}

double ShotPipeline::room_for_rows() {
    const device::RowPool pool = acu_.unload(row_pool_).front();
    const double kept = shot().rows_kept;
    return pool.taken > pool.size ? kept : kept * pool.size / pool.taken;
}

std::vector<std::uint32_t> ShotPipeline::shots_of() { return acu_.unload(shots_of_); }

std::vector<std::int32_t> ShotPipeline::proxel_counts() {
    auto counts = acu_.unload(proxel_count_);
    counts.resize(stride_ + kSpareCounts);
    return counts;
}

void ShotPipeline::clear_counts() {
    acu_.clear(proxel_count_);
    acu_.clear(covered_count_);
    acu_.clear(factors_);
}

std::vector<float> ShotPipeline::factors() { return acu_.unload(factors_); }

Activity ShotPipeline::activity() {
    const auto totals = acu_.unload(activity_);
    acu_.clear(activity_);
    return {totals[kUsefulProxels], totals[kVisitedAreas], totals[kTilePatches]};
}

std::vector<std::int32_t> ShotPipeline::owners() {
    const auto plural = acu_.unload(owners_);
    std::vector<std::int32_t> owners(std::size_t{resolution_} * resolution_);
    const std::uint32_t tile_columns = quotient_up(resolution_, array_.tile_width);
    const std::size_t tile_proxels = std::size_t{array_.tile_width} * array_.tile_height;
    for (std::uint32_t row = 0; row < resolution_; ++row)
        for (std::uint32_t column = 0; column < resolution_; ++column) {
            const std::uint32_t tile =
                row / array_.tile_height * tile_columns + column / array_.tile_width;
            owners[std::size_t{row} * resolution_ + column] =
                plural[tile * tile_proxels +
                       array_.proxel_place(column % array_.tile_width, row % array_.tile_height)];
        }
    return owners;
}

std::vector<std::int32_t> ShotPipeline::visible_patches() {
    const auto levels = acu_.unload(stack_);
    const auto heights = acu_.unload(stack_height_);
    std::vector<std::int32_t> result;
    for (std::size_t pe = 0; pe < heights.size(); ++pe) {
        const auto first =
            levels.begin() + static_cast<std::ptrdiff_t>(pe * (depth_ / array_.lanes));
        std::for_each(first, first + heights[pe], [&](const device::Level& level) {
            for (std::int32_t lane = 0; lane < std::int32_t(array_.lanes); ++lane)
                if ((level.visible >> lane & 1) != 0) result.push_back(level.patch + lane);
        });
    }
    return result;
}

template <class T>
std::vector<T> ShotPipeline::projected(const mp1map::Plural<T>& plural) {
    const auto slots = acu_.unload(plural);
    const auto counts = acu_.unload(projection_count_);
    std::vector<T> result;
    for (std::size_t pe = 0; pe < counts.size(); ++pe)
        result.insert(result.end(), slots.begin() + static_cast<std::ptrdiff_t>(pe * depth_),
                      slots.begin() + static_cast<std::ptrdiff_t>(pe * depth_ + counts[pe]));
    return result;
}

std::vector<device::Projection> ShotPipeline::projections() { return projected(projections_); }

std::vector<device::Rectangle> ShotPipeline::rectangles() { return projected(rectangles_); }

}  // namespace hemirad
