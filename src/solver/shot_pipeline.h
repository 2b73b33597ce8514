#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/shared.h"
#include "mp1map/acu.h"
#include "mp1map/pe_array.h"
#include "solver/near_pairs.h"
#include "solver/patch_arrays.h"
#include "solver/solve_state.h"

namespace hemirad {

/// Variants of the paper that the fastest form leaves out. All but `incremental` and `constant`
/// give the same bits.
struct Variants {
    bool incremental = false;        ///< sec. 1.6: further areas by summing deltas
    bool constant_distance = false;  ///< app. A: Spencer's one distance a patch
    bool xnet = false;               ///< sec. 1.5.4: form factors gathered over the X-net
};

/// How a hemisphere's proxels become form factors.
enum class FormFactorMode {
    count,     ///< proxels owned over those of the disk (sec. 1.5.4)
    analytic,  ///< closed form times the visible fraction of the patch's proxels
};

/// What fig. 1.4b counts, of the last shot.
struct Activity {
    std::uint32_t useful_proxels = 0;  ///< inside an outline
    std::uint32_t visited_areas = 0;   ///< by a patch
    std::uint32_t tile_patches = 0;    ///< patches taken by a tile
};

struct PipelineSettings {
    std::uint32_t resolution = 512;
    std::uint32_t shooter_samples = 1;        ///< M x M hemispheres a shooter,
    std::vector<std::int32_t> patch_samples;  ///< [shooter] unless these are given
    FormFactorMode form_factor = FormFactorMode::count;
    NearPairs near_pairs;  ///< for FormFactorMode::analytic; may be empty
    double tolerance = 1e-3;
    std::uint32_t salvo = 1;      ///< shooters that look and shoot at once, up to kMostSalvo
    std::uint64_t row_bytes = 0;  ///< for rows of form factors, which spare a shooter's next shots
    mp1map::PeArrayRequest pe_array;
    std::optional<std::filesystem::path> kernels_dir;
    bool timed = false;
    bool apart = false;  ///< every kernel launched by itself, to be timed
    Variants variants;
    bool count_shots = false;     ///< of each shooter, for shots_of()
    bool count_activity = false;  ///< activity() after each projection
    bool keep_owners = false;     ///< for tests: owners() after each projection
    /// Looks from points, aim_points() to add_up_irradiance(), and not from shooters, which gets
    /// other kernels compiled.
    bool gathers = false;
};

/// PEs of the array that runs choose_shooter alone, and of those that close a station's form
/// factors. Fixed: it decides the order in which fluxes are added.
inline constexpr std::uint32_t kReducePes = 64;

/// Rows are found by 31 bits of units of two words.
inline constexpr std::uint64_t kMostRowBytes = std::uint64_t{1} << 34;

/// Flux and reflectance of the solved bands, [band * shooter_stride + shooter]; the fluxes of a
/// band add up to 1, or to 0 where it is dark.
struct PatchLight {
    std::size_t band_count = 1;
    std::vector<float> emitted;
    std::vector<float> reflectance;
    std::vector<float> band_weight;  ///< [band] 1, or 0 for a dark band
};

/// One band in which every patch emits and reflects alike: for measurements and tests.
PatchLight even_light(const PatchArrays& patches, float reflectance = 0.5f);

/// The kernels of a shot and the plural variables they work on: one method a kernel, of its name.
/// What a shooter sees and what becomes of its flux stays on the device.
class ShotPipeline {
  public:
    /// Without `shooters` every patch shoots for itself.
    ShotPipeline(const PatchArrays& patches, const PatchLight& light,
                 const PipelineSettings& settings, const mp1map::Device& device,
                 const ShooterArrays& shooters = {});

    /// Other patches, as many and of as many corners as before; each shoots for itself.
    void load(const PatchArrays& patches);

    void init_plane();
    void aim_hemisphere();
    void prepare_patches();
    void prefix_sum();
    void bin_areas();
    void project_patches();
    void estimate_form_factors();
    void correct_near_pairs();
    void add_up_factors();
    void spread_residual();
    void receive_flux();
    void choose_shooter();

    /// What prepare_patches() and receive_flux() consist of.
    void cull_patches();
    void set_up_projection();
    void count_areas();
    void update_radiosity();
    void update_unshot();

    /// A salvo of the final gather's points, `first` and on of those below `end`.
    void aim_points(std::uint32_t first, std::uint32_t end);
    void gather_irradiance();
    void add_up_irradiance();

    /// What patches send to points, [band * stride() + patch].
    void load_radiosity(const std::vector<float>& radiosity);
    void load_points(const std::vector<device::GatherPoint>& points);
    /// Waits; [point * bands + band] of the points that were loaded last.
    std::vector<float> gathered() { return acu_.unload(gathered_); }

    /// Waits; how far the device has come: the first shooter of the salvo or, of those whose lists
    /// are full, the one with the longest.
    device::Shot shot();
    void set_shot(const device::Shot& shot);
    /// The next shooter, instead of the most energetic one; its first hemisphere is `part`. Of
    /// salvos of one.
    void set_shooter(std::uint32_t shooter, std::uint32_t part = 0);
    /// Goes on after kPaused: until there are so many shots in all, or somewhat more that go at
    /// once; `most` are never exceeded.
    void set_shot_limit(std::uint64_t shots, std::uint64_t most);
    /// After kBinsFull: makes room for the lists and lets the halted salvo be repeated.
    void enlarge_lists();

    /// After the last shot, whatever of the next ones is under way.
    SolveState state();
    /// A shot at nothing then finds the next shooters, whose rows remain known. Throws InputError
    /// where the state is that of other patches or bands.
    void set_state(const SolveState& state);

    std::vector<double> received();         ///< [band * stride + patch], of the emitted flux
    std::vector<float> unshot();            ///< [band * shooter_stride + shooter]
    std::vector<double> escaped();          ///< [band]
    std::vector<std::uint32_t> shots_of();  ///< [shooter] that it made; empty unless count_shots
    /// Of the hemispheres since the last shot; after the patches' (stride()) those that escaped.
    std::vector<std::int32_t> proxel_counts();
    void clear_counts();
    /// Of the hemispheres since the last shot, [kind * stride() + patch], kinds as kVisibleFactor;
    /// FormFactorMode::analytic.
    std::vector<float> factors();
    /// Owner of proxel row * resolution + column; patch_count() + padding: escaped. keep_owners.
    std::vector<std::int32_t> owners();
    std::int32_t escaped_owner() const { return static_cast<std::int32_t>(stride_); }
    Activity activity();                            ///< since the last call; count_activity
    std::vector<std::int32_t> visible_patches();    ///< of the last hemisphere, ascending
    std::vector<device::Projection> projections();  ///< of those with a proxel, ascending
    std::vector<device::Rectangle> rectangles();    ///< of projections()

    FormFactorMode mode() const { return mode_; }
    std::uint64_t disk_proxels() const { return disk_proxels_; }  ///< of one hemisphere
    std::uint32_t part_count(std::uint32_t shooter) const;        ///< its hemispheres
    std::uint32_t most_parts() const;                             ///< of any shooter
    const mp1map::PeArray& pe_array() const { return array_; }
    std::uint32_t stride() const { return stride_; }
    std::uint32_t shooter_stride() const { return shooter_stride_; }
    std::uint32_t salvo() const { return salvo_; }
    /// Waits; rows that there will be room for, if others are as those that are kept; 0 where none
    /// is.
    double room_for_rows();
    std::size_t band_count() const { return band_count_; }
    mp1map::Acu& acu() { return acu_; }
    std::uint64_t device_bytes() const { return acu_.allocated_bytes(); }
    double build_seconds() const { return build_seconds_; }

  private:
    mp1map::Kernel& kernel(const std::string& name);
    void build_kernels(const mp1map::Device& device, const PipelineSettings& settings,
                       std::uint32_t corner_count);
    void load_shooters(const PatchArrays& patches, const ShooterArrays& shooters);
    void load_near_pairs(const NearPairs& pairs);
    void take_back_promised_rows();
    template <class T>
    std::vector<T> projected(const mp1map::Plural<T>& plural);  // what is set up of [pe][slot]
    // Those that shoot and those that look ahead, as MEMBERS in progress.clh.
    std::uint32_t member_count() const { return salvo_ == 1 ? 1 : 2 * salvo_; }
    std::uint32_t gathered_bands() const {
        return static_cast<std::uint32_t>(radiosity_.size() / stride_);
    }
    mp1map::Grid flux_grid() const;
    mp1map::Grid salvo_stack_grid() const;
    mp1map::Grid salvo_tile_grid() const;

    mp1map::PeArray array_;
    mp1map::Acu acu_;
    std::map<std::string, mp1map::Kernel> kernels_;
    double build_seconds_ = 0;

    std::uint32_t resolution_, stride_, shooter_stride_, salvo_;
    std::size_t band_count_;
    std::uint32_t tile_count_, stack_count_, depth_;
    std::uint64_t disk_proxels_;
    FormFactorMode mode_;
    bool two_levels_, apart_;
    float tolerance_;
    std::vector<std::int32_t> samples_;  // [shooter]

    mp1map::Plural<device::Shot> shot_;
    mp1map::Plural<device::Cluster> clusters_;
    mp1map::Plural<std::int32_t> corners_, planes_, rooms_;
    mp1map::Plural<float> normals_, roots_;
    mp1map::Plural<std::uint8_t> rims_;
    // The patches' own where each shoots for itself.
    mp1map::Plural<std::int32_t> shooter_corners_, shooter_planes_, shooter_reached_, first_patch_;
    mp1map::Plural<float> shooter_normals_;
    mp1map::Plural<std::int32_t> shooter_samples_;
    mp1map::Plural<device::Level> stack_;
    mp1map::Plural<std::int32_t> stack_height_, projection_count_;
    mp1map::Plural<device::Projection> projections_;
    mp1map::Plural<device::Rectangle> rectangles_;
    mp1map::Plural<std::int32_t> places_, list_end_, lists_, proxel_count_, owners_;
    mp1map::Plural<std::int32_t> covered_count_, near_begin_, near_patch_;
    mp1map::Plural<float> near_factor_, factors_, factor_block_sums_;
    mp1map::Plural<float> received_, received_rest_, unshot_, reflectance_, band_weight_;
    mp1map::Plural<float> shot_flux_, escaped_, block_unshot_;
    // Rows that are kept, see kernels/rows.clh; and those of this shot, or what each PE has of
    // them.
    mp1map::Plural<std::uint32_t> rows_;
    mp1map::Plural<device::RowPool> row_pool_;
    mp1map::Plural<device::Extent> row_extents_;     // [PE]
    mp1map::Plural<std::int32_t> row_of_;            // [shooter] where its row is; 0: it has none
    mp1map::Plural<float> row_escaped_, shot_rows_;  // [shooter] what its row lacks
    mp1map::Plural<device::GatherPoint> points_;
    mp1map::Plural<float> radiosity_, block_irradiance_, gathered_;
    mp1map::Plural<std::uint32_t> activity_, shots_of_;
    mp1map::Plural<device::BlockSummary> summaries_;
};

/// The files of kernels/ that a pipeline is made of, in the order of a shot.
std::vector<std::string> kernel_names(FormFactorMode mode);

/// The same of a final gather.
std::vector<std::string> gather_kernel_names(FormFactorMode mode);

/// Those of them that a shot of one level launches, unless they are to run apart.
std::vector<std::string> launched_kernels(FormFactorMode mode);

/// Proxels whose centre lies in the disk (sec. 1.3.2), of resolution^2.
std::uint64_t disk_proxel_count(std::uint32_t resolution);

/// Bytes a pipeline holds on the device; near pairs, 8 bytes each, come on top.
std::uint64_t estimated_device_bytes(std::uint32_t patches, std::uint32_t shooters,
                                     std::uint32_t corner_count, std::size_t bands,
                                     std::uint32_t resolution, FormFactorMode mode,
                                     std::uint64_t row_bytes, const mp1map::PeArray& array,
                                     std::uint32_t salvo = 1, bool count_shots = false);

/// What a kept row takes of a scene of so many patches, of which its shooter sees a part.
std::uint64_t estimated_row_bytes(double seen_patches, std::uint64_t patches);

}  // namespace hemirad
