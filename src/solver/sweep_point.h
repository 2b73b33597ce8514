#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mp1map/cost_model.h"
#include "mp1map/device.h"
#include "mp1map/pe_array.h"
#include "solver/patch_arrays.h"
#include "solver/shot_pipeline.h"

namespace hemirad {

/// A machine to be measured: what is run, and the MP-1 whose areas are counted and whose seconds
/// are modelled. An area has one proxel a PE of that MP-1 (sec. 1.5.5), however many lanes, tiles
/// or work-groups the device is given.
struct SweepPoint {
    std::uint32_t resolution = 1024;
    std::uint32_t mp1_width = 32, mp1_height = 32;
    mp1map::PeArrayRequest pe_array = {};
    Variants variants = {};
};

/// Bounding rectangles and useful PEs of one shot: what no PE array changes.
struct PlaneView {
    struct Rectangle {
        mp1map::ProxelRange columns, rows;
        std::uint32_t patch = 0;
    };
    std::vector<Rectangle> visible;  ///< empty ones, too small for a proxel's centre, included
    std::uint64_t useful_proxels = 0;
};

/// Counts of one shot on one array; the means of a point are taken over its shots.
struct ShotAreas {
    std::uint64_t visible = 0, projected = 0, areas = 0, tile_patches = 0, useful = 0;
};

/// Patches of a scene, and shooters spread evenly over them.
class SweepScene {
  public:
    SweepScene(PatchArrays patches, std::uint32_t shots);

    const PatchArrays& patches() const { return patches_; }
    const std::vector<std::uint32_t>& shooters() const { return shooters_; }
    /// Of every shooter; counted at the first call for a resolution.
    const std::vector<PlaneView>& views(std::uint32_t resolution, const mp1map::Device& device);

  private:
    PatchArrays patches_;
    std::vector<std::uint32_t> shooters_;
    std::map<std::uint32_t, std::vector<PlaneView>> views_;
};

/// Means over the shots, unless named otherwise.
struct SweepMeasurement {
    mp1map::PeArray pe_array;
    double visible = 0, projected = 0;  ///< patches
    double stack_levels = 0;            ///< of the highest stack, patches dealt out in turn
    std::vector<double> stack_fill;     ///< [level] part of the PEs that hold a visible patch there
    double tile_patches = 0;            ///< that the arrays took, those of several tiles anew
    double areas = 0, useful = 0;       ///< visited areas; proxels inside, summed over them
    double seconds_min = 0, seconds_median = 0;         ///< over the shooters, each one's fastest
    std::map<std::string, double> kernel_seconds = {};  ///< of a shot
    mp1map::Mp1Seconds mp1 = {};
};

/// Areas of the array that a shot visits. Block distribution (fig. 1.3) gives each PE one block of
/// the plane; the control unit issues one address to all PEs, so there are as many lockstep steps
/// as the rectangle covers places of a block.
ShotAreas count_areas(const PlaneView& view, const SweepPoint& point, const mp1map::PeArray& array);

/// Stack heights of the MP-1's PEs, patch p on PE p modulo their number: how many PEs hold a
/// visible patch on each level (sec. 1.5.1).
std::vector<std::uint32_t> stack_levels(const PlaneView& view, std::uint32_t pe_count);

/// What the cost model takes of such a shot, levels evenly shared.
mp1map::ShotCounts mp1_counts(const ShotAreas& shot, const SweepPoint& point,
                              const PatchArrays& patches);

/// Throws mp1map::NoSuchDevice where the device cannot hold the array.
SweepMeasurement measure(SweepScene& scene, const SweepPoint& point, const mp1map::Device& device);

/// Proxels of the disk that get another owner than by direct evaluation, of a million, on average
/// over the shooters.
double wrong_per_million(const SweepScene& scene, SweepPoint point, const mp1map::Device& device);

}  // namespace hemirad
