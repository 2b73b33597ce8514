#pragma once

#include <cstdint>

namespace mp1map {

/// Operations of one PE, 32 bits wide. Comparisons, selections, masks and moves count as integers.
struct Operations {
    double multiplications = 0, additions = 0, divisions = 0, square_roots = 0, integers = 0;

    bool operator==(const Operations&) const = default;
};
Operations operator+(const Operations& a, const Operations& b);
Operations operator*(double times, const Operations& a);

/// An MP-1 of width x height PEs. Defaults are the paper's machine; docs/mp1-cost-model.md has the
/// source of every constant. All times are in seconds, of one PE or, as SIMD has it, of all.
struct Mp1 {
    std::uint32_t width = 32, height = 32;
    double clock = 83e-9;                         ///< published; a unit to compare with, no more
    double float_operation = 1024 / 75e6;         ///< published: 75 Mflop/s of 1,024 PEs
    double integer_operation = 1024 / 1600e6;     ///< published: 1,600 Mop/s of 1,024 PEs
    double xnet_byte = 1024 / 1.4e9;              ///< published: 1.4 GB/s of 1,024 PEs, neighbours
    double diffused_byte = 0.75 / (1024 * 100.);  ///< sec. 1.6: 1,024 times 100 bytes in 0.75 s
    double division = 2, square_root = 3;         ///< guesses, in float_operations

    std::uint64_t pe_count() const { return std::uint64_t{width} * height; }
    double seconds(const Operations& operations) const;
};

/// What one shot does, counted exactly. An area holds one proxel a PE (sec. 1.5.5), so the second
/// block belongs to one array: count it anew for another.
struct ShotCounts {
    std::uint64_t patches = 0;          ///< in the scene
    std::uint64_t patches_visible = 0;  ///< set up and diffused
    std::uint32_t edges_per_patch = 3;
    double bytes_per_patch = 100;  ///< of projection parameters; "about 100" in sec. 1.6
    std::uint32_t bands = 1;       ///< of wavelength, in the update

    std::uint64_t levels = 0;  ///< visible patches on the highest stack; 0: an even share
    std::uint64_t patches_projected = 0;  ///< visible ones that touch an area
    std::uint64_t areas_visited = 0;      ///< pairs of patch and area
    std::uint64_t proxels_inside = 0;     ///< outlines, summed over those pairs: useful PEs
    std::uint64_t plane_areas = 0;
};

/// Values of the arcs and of the distance in the areas after a patch's first (sec. 1.6).
enum class Evaluation {
    direct,       ///< in full, 3 multiplications and 2 additions each
    deltas,       ///< A u + B v by adding a delta; C w in full, since w is no linear function
    deltas_only,  ///< one addition each, as sec. 1.6 reads to the letter: a lower bound
};

/// Where a PE looks for the patch that passes by (sec. 1.5.4).
enum class Search {
    rectangle,  ///< in the areas of its bounding rectangle, the mean number of them: a lower bound
    whole_plane,  ///< in all of its proxels, as sec. 1.5.4 reads to the letter: an upper bound
};

struct Variant {
    Evaluation evaluation = Evaluation::deltas;
    Search search = Search::rectangle;
};

/// Seconds of a shot by the steps of sec. 1.5.
struct Mp1Seconds {
    double cull = 0, set_up = 0, diffusion = 0, inside_tests = 0, depth = 0, accumulate = 0,
           update = 0, choose = 0;

    /// Sec. 1.5.3: what is done one patch at a time.
    double projection() const { return diffusion + inside_tests + depth; }
    double total() const { return cull + set_up + projection() + accumulate + update + choose; }
};

Mp1Seconds seconds(const ShotCounts& counts, const Mp1& mp1, const Variant& variant = {});

/// How many times as fast `to` is.
double speed_up(const Mp1Seconds& from, const Mp1Seconds& to);
double diffusion_share(const Mp1Seconds& shot);
/// Fig. 1.4b: mean number of proxels inside the outline in an area visited.
double useful_pes(const ShotCounts& counts);

/// First and last index on an axis of the plane; empty where last < first.
struct ProxelRange {
    std::uint32_t first = 1, last = 0;
};
/// How many areas a bounding rectangle touches (sec. 1.5.5).
std::uint64_t areas_touched(ProxelRange columns, ProxelRange rows, std::uint32_t area_width,
                            std::uint32_t area_height);
/// Areas of a plane of resolution x resolution proxels.
std::uint64_t areas_of_plane(std::uint32_t resolution, std::uint32_t area_width,
                             std::uint32_t area_height);
/// Height of the stacks of `pe_count` PEs that `patches` are dealt out to evenly.
std::uint64_t stack_levels(std::uint64_t patches, std::uint64_t pe_count);

/// Operations a PE makes, by hand from the kernels of the same names; the table is in the docs.
Operations inside_test(std::uint32_t edges);  ///< a proxel of a patch's first area (app. A)
Operations distance_test();                   ///< the same, for the depth buffer
Operations cull_patches(std::uint32_t edges);
Operations set_up_projection(std::uint32_t edges);
Operations update_radiosity(std::uint32_t bands);

}  // namespace mp1map
