#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "scene/mesh.h"
#include "solver/bands.h"
#include "solver/forecast.h"
#include "solver/shot_pipeline.h"
#include "solver/solution.h"

namespace hemirad {

struct SolverSettings {
    std::uint32_t resolution = 512;  ///< N x N proxels on the square around the disk, 16 to 8192
    std::uint32_t shooter_samples =
        0;  ///< M x M hemispheres a shooting patch; 0: see sampling_error
    FormFactorMode form_factor = FormFactorMode::analytic;
    /// What a near pair's factor may lack for the shooter being a few points: where it would be
    /// more, counting gets more hemispheres, and analytic factors come from polygon to polygon.
    double sampling_error = 1e-3;
    double tolerance = 1e-3;  ///< stop where unshot / emitted is below, in every band
    std::uint64_t max_shots = std::numeric_limits<std::uint64_t>::max();
    double time_limit = std::numeric_limits<double>::infinity();  ///< s
    /// Calls back whenever the shots reach a multiple of one of these, or as soon as those that go
    /// at once allow, besides a few times a second; 0: not.
    std::vector<std::uint64_t> stop_every = {};
    /// For rows of form factors, see usable_row_bytes(): a shooter whose row is kept need not look
    /// again.
    std::optional<std::uint64_t> row_bytes = {};
    std::uint32_t salvo = 0;  ///< see usable_salvo()
    mp1map::PeArrayRequest pe_array = {};
    Variants variants = {};
    std::optional<std::filesystem::path> kernels_dir = {};  ///< read kernels from here
    bool timed = false;                                     ///< keep the seconds of each kernel
    bool count_shots = false;  ///< for Solution::shots_of; changes no bit
    PartSettings parts = {};  ///< more bands to solve; those of direct light change no other's bits
};

/// Bands that a device can solve at once.
std::uint64_t most_bands(const mp1map::DeviceSummary& device, const mp1map::PeArray& array);

/// What a device can spare of the bytes asked for: up to a quarter of its memory. By default 1 GiB
/// is asked for, and nothing is used where it holds the rows of fewer than one shooter in a
/// hundred: a large mesh takes what its patches take.
std::uint64_t usable_row_bytes(const std::optional<std::uint64_t>& wanted, std::uint64_t shooters,
                               std::uint64_t patches, const mp1map::DeviceSummary& device);

/// Shooters that look and shoot at once: as many as wanted, at most kMostSalvo; 0: by the mesh and
/// the resolution, so that bits do not depend on the device. 8 cost a thousandth more shots, and
/// each 100 bytes a patch and 4 a proxel. Where there are fewer than 1,024 shooters time does not
/// matter and the loop is the paper's, one at a time; beyond 262,144 patches or 2,048^2 proxels
/// memory does.
std::uint32_t usable_salvo(std::uint32_t wanted, std::uint64_t shooters, std::uint64_t patches,
                           std::uint32_t resolution);
constexpr std::uint32_t kMostSalvo = 15;

struct Progress {
    std::uint64_t shots = 0;
    double unshot_fraction = 1;
    double seconds = 0;  ///< since solve() began
};

/// What the hemispheres see at which the pipeline is aimed is counted.
void project_aimed(ShotPipeline& pipeline);

/// What the next of the shooter's hemispheres sees is counted.
void project_hemisphere(ShotPipeline& pipeline);

/// What all hemispheres of `patch` see is counted, instead of what came before; the lists are
/// enlarged as needed.
void project_shooter(ShotPipeline& pipeline, std::uint32_t patch);

/// FormFactorMode::analytic: the shooter's factors from all its hemispheres add up to 1.
void close_form_factors(ShotPipeline& pipeline);

/// The shooter's flux goes by the row of form factors that its hemispheres have counted, or that is
/// known of it; and who shoots next.
void distribute_flux(ShotPipeline& pipeline);

/// One pass of the loop of sec. 1.5.4: one hemisphere of the shooter that the pipeline has chosen
/// and, if it was the last one, what it shoots and who shoots next.
void shoot(ShotPipeline& pipeline);

enum class Stop { converged, max_shots, time_limit, interrupted };

/// Proxels that patches own and that escape, over those in the disk, of the hemispheres of a shot,
/// those made ahead of their shots included; both 1.
struct Closure {
    double least = 1, most = 1;
};

/// Progressive radiosity by hemispherical projection: the loop of sec. 1.5.4 on one device. All
/// state of the radiosity stays on the device until solution() asks for it.
class ProgressiveSolver {
  public:
    /// Uploads the mesh and builds the kernels. Throws InputError, mp1map::DeviceError or
    /// mp1map::NoSuchDevice.
    ProgressiveSolver(const Mesh& mesh, const SolverSettings& settings,
                      const mp1map::Device& device);

    /// Shoots until the tolerance or a limit is met, or the callback returns false. May be called
    /// again. A scene that emits nothing has converged.
    Stop solve(const std::function<bool(const Progress&)>& on_progress);

    /// Of solve(), whatever its time limit. To be called first; changes no bit. Nothing of a solve
    /// that takes less than `least_seconds` for certain, and where `go_on`, asked now and then, says
    /// no.
    std::optional<Forecast> forecast(
        double least_seconds = 0, const std::function<bool()>& go_on = [] { return true; });

    /// Goes on from the state() of a solver of the same mesh and the same settings, but for limits
    /// and a tolerance that were not met before: solve() then ends with the bits of one that never
    /// stopped. To be called first. Throws InputError where the state is that of another mesh.
    void resume(const SolveState& state);
    /// The last state that solving without a limit of shots comes by as well: max_shots may have
    /// cut short those that went at once.
    SolveState state();

    Solution solution();
    Closure closure();
    std::uint64_t repeated_shots();  ///< of all, by known rows
    const mp1map::PeArray& pe_array() const;
    std::uint64_t device_bytes() const;  ///< memory held on the device
    double build_seconds() const;        ///< that the kernels took to compile
    /// Seconds and launches by kernel; empty unless timed.
    std::map<std::string, std::pair<double, std::uint64_t>> kernel_seconds();

  private:
    void find_first_shooters();
    Progress advance(std::uint64_t passes);
    std::uint64_t next_pause(std::uint64_t shots) const;
    std::uint64_t passes_to(std::uint64_t shots) const;  // that make so many for certain
    bool may_be_cut_short(std::uint64_t shots) const;    // those that go at once after so many

    const Mesh& mesh_;
    SolverSettings settings_;
    BandPlan plan_;
    ShotPipeline pipeline_;
    std::uint64_t repeats_ = 0;        // shots by known rows that are sent off with each pass
    std::optional<SolveState> uncut_;  // as far as max_shots decided nothing
};

}  // namespace hemirad
