// Structs and constants that host and device share. Only int, uint and float, so that both
// compilers lay them out alike; the host checks the sizes.
#ifndef HEMIRAD_SHARED_H
#define HEMIRAD_SHARED_H

#ifndef __OPENCL_VERSION__
#include <cstdint>
namespace hemirad::device {
using std::int32_t;
using std::uint32_t;
#else
typedef int int32_t;
typedef uint uint32_t;
#endif

// The scene is normalised into [-1, 1]. kEdgeMargin is the length by which every arc is moved
// outwards, so that no proxel is lost between neighbours; what two patches then both claim goes
// to the nearer one. It stands for the rounding of an arc's value: with e = 2^-24 and distances up
// to r, a vertex is displaced by 0.9 e when it becomes a float, by r e in its difference to the
// shooter, and rotation, cross product, normalisation and evaluation add about 3 r e each where
// their errors are random. Across half of the scene, r = 1, that is 12.6 e = 7.5e-7. The errors of
// all steps in one direction at opposite corners (r = 3.5) would be four times as much; no case
// of that is known, and the tests look for it.
#define kEdgeMargin 7.5e-7f
// A patch is seen only if the shooter lies in front of its plane, and it in front of the
// shooter's, by more than that: below, nothing but rounding tells front from back. Half of the
// margin of the edges, so that neighbours cover what is dropped here.
#define kPlaneMargin 3.5e-7f

// What update_radiosity and choose_shooter add up at a time. Fixed, so that sums of floats have
// one order whatever the PE array.
#define kReduceBlock 64

// Counters of fig. 1.4b, of one shot: proxels inside an outline, areas visited by a patch, and
// patches taken by a tile.
#define kUsefulProxels 0
#define kVisitedAreas 1
#define kTilePatches 2
#define kActivityCounters 3

#define kRunning 0
#define kConverged 1
#define kBinsFull 2  // the lists of the tiles outgrew their buffer; the host enlarges it
#define kExhausted 3  // nothing is left to shoot
#define kPaused 4     // as many shots as the host asked for

// What the PEs know of the shooting patch, and the host of the progress.
typedef struct {
    float origin[3];  // one of the shooter's hemispheres, normalised scene units
    float u_axis[3], v_axis[3], normal[3];
    int32_t patch;
    uint32_t part, part_count;  // its hemispheres: aimed so far, and all
    int32_t status;
    uint32_t shots, shot_limit;
    uint32_t bin_entries;  // patches in the lists of all tiles
    float unshot_fraction;    // largest of the bands
    // Closure, of all shots: proxels owned and escaped, less those of the disks; both 0.
    int32_t least_surplus, most_surplus;
    uint32_t escaped_proxels;  // of the last shot
    // Analytic form factors of the last shot: what closes them, and what escapes.
    float factor_scale, residual_share, escaped_fraction;
} Shot;

// Projection parameters of one patch (sec. 1.5.2): 72 bytes; "about 100" in sec. 1.6.
// An edge is (A, B, C) of eq. 1.2, of unit moment: its value is a length, positive inside.
// depth is (A", B", C") of app. A. columns and rows are first | last << 16, of proxels.
typedef struct {
    float edge[4][3];
    float depth[3];
    int32_t patch;
    uint32_t columns, rows;
} Projection;

// The most energetic patch of kReduceBlock patches, and the proxels they own in a shot.
typedef struct {
    float energy;  // unshot flux over the bands' weights
    int32_t patch;
    uint32_t proxels;
} BlockSummary;

// Form factors in the making, [kind][patch], sums over the shooter's hemispheres: closed form times
// visible fraction v, closed form alone, and closed form times v (1 - v).
#define kVisibleFactor 0
#define kUnblockedFactor 1
#define kDoubtfulFactor 2
#define kFactorKinds 3

// After the patches' proxel counts: see choose_shooter.cl.
#define kSpareCounts 3

#ifndef __OPENCL_VERSION__
static_assert(sizeof(BlockSummary) == 12);
static_assert(sizeof(Shot) == 104);
static_assert(sizeof(Projection) == 72);
}  // namespace hemirad::device
#endif

#endif
