#include "mp1map/cost_model.h"

#include <bit>
#include <cassert>

namespace mp1map {
namespace {

// Vector algebra of kernels/hemisphere.clh; a fused operation is its two parts.
constexpr Operations kDifference{.additions = 3};
constexpr Operations kDot{.multiplications = 3, .additions = 2};
constexpr Operations kCross{.multiplications = 6, .additions = 3};
constexpr Operations kScaling{.multiplications = 3};
constexpr Operations kRotation{.multiplications = 9, .additions = 6};

// Au + Bv + Cw: eq. 1.2, and -1/rho of app. A.
constexpr Operations kPlaneValue{.multiplications = 3, .additions = 2};

// kernels/ellipse_bounds.clh
constexpr Operations kIncludeValue{.integers = 6};
constexpr Operations kSquaresOfArc{.multiplications = 3, .additions = 2};
constexpr Operations kExtremumValue{
    .multiplications = 4, .additions = 3, .divisions = 1, .square_roots = 1, .integers = 11};
constexpr Operations kEndsOfArc{.divisions = 4, .square_roots = 2, .integers = 6};
constexpr Operations kDistanceOfArc{.square_roots = 1, .integers = 9};
constexpr Operations kProxelRange{
    .multiplications = 2, .additions = 5, .divisions = 1, .integers = 11};

// kernels/clip.clh
constexpr Operations kCrossing{.multiplications = 2, .additions = 6, .divisions = 1, .integers = 1};
constexpr Operations kChoiceOfEnds{.integers = 19};

// A PE compares its proxel's patch with the passing one, and counts.
constexpr Operations kSearchedProxel{.integers = 2};
// Words of 4 bytes that travel: patch and count, and the rectangle's columns and rows with them.
constexpr double kTravellingBytes = 8, kRectangleBytes = 8;

// The reduction carries an energy and a patch; the larger one wins: a comparison, two selections.
constexpr double kReducedBytes = 8;
constexpr Operations kReductionStep{.integers = 3};

// Depth and patch of a proxel, as a plane is cleared.
constexpr Operations kClearedProxel{.integers = 2};

Operations include_arc() {
    return kDifference + 4 * kDot + kEndsOfArc + 4 * kIncludeValue + kSquaresOfArc +
           2 * (kExtremumValue + 2 * kIncludeValue) + kDistanceOfArc;
}

Operations edge_plane() {
    return kDifference + kDot + kCross + kScaling +
           Operations{.divisions = 1, .square_roots = 1, .integers = 3};
}

Operations depth_plane() {
    return kDifference + kDot + kRotation + kScaling + Operations{.divisions = 1};
}

Operations clipped_bounds(std::uint32_t edges) {
    const Operations horizon = include_arc();
    return edges * (kCrossing + kChoiceOfEnds + include_arc()) + horizon;
}

// Stepping to another area changes u or v by a constant, so A u + B v by one addition; the root w
// is read from the proxel, and C w costs a product and a sum as before.
Operations further_value(Evaluation evaluation) {
    switch (evaluation) {
        case Evaluation::direct:
            return kPlaneValue;
        case Evaluation::deltas:
            return {.multiplications = 1, .additions = 2};
        case Evaluation::deltas_only:
            return {.additions = 1};
    }
    return kPlaneValue;
}

// Of a sign for each arc; of a comparison and two stores for the depth.
Operations activity(std::uint32_t edges) { return {.integers = static_cast<double>(edges)}; }
constexpr Operations kDepthBuffer{.integers = 3};

double log2_steps(std::uint32_t size) { return std::bit_width(size - 1); }

// A guess: halves are folded onto halves, and a transfer over d PEs costs d of neighbours. The
// distances 1, 2, 4 ... of a row of n add up to n - 1.
double reduction(const Mp1& mp1) {
    const double distance = (mp1.width - 1.) + (mp1.height - 1.);
    const double steps = log2_steps(mp1.width) + log2_steps(mp1.height);
    return distance * kReducedBytes * mp1.xnet_byte + mp1.seconds(steps * kReductionStep);
}

// Mean over the patches. PEs search for different patches at once, in lockstep, so the PE whose
// patch touches most areas would set the pace; no count says which.
double searched_areas(const ShotCounts& counts, Search search) {
    if (search == Search::whole_plane) return static_cast<double>(counts.plane_areas);
    if (counts.patches_projected == 0) return 0;
    return static_cast<double>(counts.areas_visited) /
           static_cast<double>(counts.patches_projected);
}

// A PE's patch passes all PEs, one X-net step each; all patches of a level travel at a time.
double travel(const ShotCounts& counts, const Mp1& mp1, Search search) {
    const double bytes = kTravellingBytes + (search == Search::rectangle ? kRectangleBytes : 0);
    const double search_of_areas = mp1.seconds(searched_areas(counts, search) * kSearchedProxel);
    return static_cast<double>(mp1.pe_count()) * (bytes * mp1.xnet_byte + search_of_areas);
}

}  // namespace

Operations operator+(const Operations& a, const Operations& b) {
    return {a.multiplications + b.multiplications, a.additions + b.additions,
            a.divisions + b.divisions, a.square_roots + b.square_roots, a.integers + b.integers};
}

Operations operator*(double times, const Operations& a) {
    return {times * a.multiplications, times * a.additions, times * a.divisions,
            times * a.square_roots, times * a.integers};
}

double Mp1::seconds(const Operations& operations) const {
    const double floats = operations.multiplications + operations.additions +
                          division * operations.divisions + square_root * operations.square_roots;
    return floats * float_operation + operations.integers * integer_operation;
}

Operations inside_test(std::uint32_t edges) { return edges * kPlaneValue + activity(edges); }

Operations distance_test() { return kPlaneValue + kDepthBuffer; }

Operations cull_patches(std::uint32_t edges) {
    // The highest corner; the facing; the two margins; the push onto the stack.
    return edges * (kDifference + kDot) + (edges - 1) * Operations{.integers = 2} + kDot +
           Operations{.integers = 3} + Operations{.integers = 2};
}

Operations set_up_projection(std::uint32_t edges) {
    return edges * (kDifference + kRotation + edge_plane()) + depth_plane() +
           clipped_bounds(edges) + 2 * kProxelRange;
}

Operations update_radiosity(std::uint32_t bands) {
    // Count to form factor; a band's flux, received and unshot flux, and its part of the energy.
    return Operations{.multiplications = 1, .integers = 2} +
           bands * Operations{.multiplications = 3, .additions = 3, .integers = 1};
}

Mp1Seconds seconds(const ShotCounts& counts, const Mp1& mp1, const Variant& variant) {
    assert(mp1.pe_count() > 0 && counts.edges_per_patch >= 3);
    assert(counts.patches_projected <= counts.patches_visible);
    assert(counts.patches_visible <= counts.patches);
    assert(counts.patches_projected <= counts.areas_visited);
    const auto edges = counts.edges_per_patch;
    const auto database_levels = static_cast<double>(stack_levels(counts.patches, mp1.pe_count()));
    const auto levels = static_cast<double>(
        counts.levels != 0 ? counts.levels : stack_levels(counts.patches_visible, mp1.pe_count()));
    const auto areas = static_cast<double>(counts.areas_visited);
    const auto first = static_cast<double>(counts.patches_projected);
    const Operations further = further_value(variant.evaluation);

    Mp1Seconds shot;
    shot.cull = database_levels * mp1.seconds(cull_patches(edges));
    shot.set_up = levels * mp1.seconds(set_up_projection(edges));
    shot.diffusion =
        static_cast<double>(counts.patches_visible) * counts.bytes_per_patch * mp1.diffused_byte;
    shot.inside_tests = mp1.seconds(first * inside_test(edges) +
                                    (areas - first) * (edges * further + activity(edges)));
    shot.depth = mp1.seconds(first * distance_test() + (areas - first) * (further + kDepthBuffer) +
                             static_cast<double>(counts.plane_areas) * kClearedProxel);
    shot.accumulate = levels * travel(counts, mp1, variant.search);
    shot.update = levels * mp1.seconds(update_radiosity(counts.bands));
    shot.choose = database_levels * reduction(mp1);
    return shot;
}

double speed_up(const Mp1Seconds& from, const Mp1Seconds& to) { return from.total() / to.total(); }

double diffusion_share(const Mp1Seconds& shot) { return shot.diffusion / shot.total(); }

double useful_pes(const ShotCounts& counts) {
    if (counts.areas_visited == 0) return 0;
    return static_cast<double>(counts.proxels_inside) / static_cast<double>(counts.areas_visited);
}

std::uint64_t areas_touched(ProxelRange columns, ProxelRange rows, std::uint32_t area_width,
                            std::uint32_t area_height) {
    if (columns.last < columns.first || rows.last < rows.first) return 0;
    const std::uint64_t across = columns.last / area_width - columns.first / area_width + 1;
    const std::uint64_t down = rows.last / area_height - rows.first / area_height + 1;
    return across * down;
}

std::uint64_t areas_of_plane(std::uint32_t resolution, std::uint32_t area_width,
                             std::uint32_t area_height) {
    if (resolution == 0) return 0;
    const ProxelRange all{0, resolution - 1};
    return areas_touched(all, all, area_width, area_height);
}

std::uint64_t stack_levels(std::uint64_t patches, std::uint64_t pe_count) {
    return (patches + pe_count - 1) / pe_count;
}

}  // namespace mp1map
