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

// The scene is normalised until half of its largest side is in [1/2, 1), and coordinates are whole
// steps of 2^-30 of that. A difference to the shooter is then exact before it becomes a float, so
// what is near to it is known as well at the rim of a scene as in the middle.
#define kGridStep (1.0f / 1073741824.0f)
// What the grid displaces a plane by against the shooter: half a step an axis for a corner of either
// patch, and for the shooter's origin, 3 sqrt(3) / 2 steps in all.
#define kGridMargin 2.5e-9f

// An arc is moved outwards by kEdgeMargin of the distance r of its nearer end (and kGridMargin),
// so that single precision loses no proxel between neighbours; what two patches then both claim
// goes to the nearer one. With e = 2^-24, the worst that can befall an edge's moment is, in e r: the
// difference of its ends 1, its product with the nearer one 2, two scalings 2, evaluation 3. A point
// at y of the edge is displaced by its conversion, e y, and turn into the shooter's frame, 3 e y,
// which changes the moment by 4 e times the distance of the edge's line, at most 4. In all
// 12 e = 7.2e-7.
#define kEdgeMargin 7.5e-7f
// A patch is seen only if the shooter lies in front of its plane, and it in front of the
// shooter's, by more than that of a corner's distance (and kGridMargin): below, nothing but rounding
// tells front from back. The normal, the corner and three roundings of their product: 5 e = 3e-7.
#define kPlaneMargin 3.5e-7f

// What update_unshot and choose_shooter add up at a time. Fixed, so that sums of floats have
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

// What the PEs know of a shooting patch, and the host of the progress: SALVO of them, of those that
// shoot at once. What tells one shooter from the next comes first, kNextShooterWords of it: the host
// may send it ahead of the kernels.
#define kNextShooterWords 8
typedef struct {
    int32_t shooter;            // negative: none, as behind the last of a smaller salvo
    uint32_t part, part_count;  // its hemispheres: aimed so far, and all
    int32_t status;
    // Where its row of form factors lies, or goes to, in units of rows.clh, and whether it is there
    // already. 0: it is not kept.
    int32_t row, row_known;
    int32_t plane;      // the shooter's, as `planes`
    int32_t is_done;    // while others of the salvo have hemispheres left
    int32_t origin[3];  // one of the shooter's hemispheres, grid steps
    float u_axis[3], v_axis[3], normal[3];
    int32_t reached;           // rooms that its light may come to, a bit each; -1: all
    int32_t is_ahead;          // its row is found, but it does not shoot yet
    uint32_t bin_entries;      // patches in the lists of all tiles
    uint32_t escaped_proxels;  // of the last shot
    // Analytic form factors of the last shot: what closes them, and what escapes.
    float factor_scale, residual_share, escaped_fraction;
    // The books of all shots, kept in the first of a salvo. Shots pause once they have reached
    // shot_limit, and never exceed most_shots.
    uint32_t shots, shot_limit, most_shots;
    float unshot_fraction;  // largest of the bands
    // Closure, of all shots: proxels owned and escaped, less those of the disks; both 0.
    int32_t least_surplus, most_surplus;
    uint32_t rows_kept;
    uint32_t repeated_shots, repeated_salvos;  // by known rows alone
} Shot;

// Memory of the rows that are kept (rows.clh): its units, of kRowUnit words, and how many are taken.
// More than there are: it is full. A PE takes kExtentUnits at a time.
#define kRowUnit 2
#define kRowBitWords (kReduceBlock / 32)
#define kExtentUnits 512
typedef struct {
    uint32_t taken, size;
} RowPool;

typedef struct {
    uint32_t next, end;  // units
} Extent;

// Where a hemisphere of the final gather stands: a point on a surface, `plane` as `planes`, `reached`
// as a Shot's.
typedef struct {
    int32_t origin[3], plane;  // grid steps
    float u_axis[3], v_axis[3], normal[3];
    int32_t reached;
} GatherPoint;

// kClusterPatches consecutive patches: the box around their corners; the mean of their normals, how
// far a normal is from it, and how far a corner is from the box's centre along it.
#define kClusterPatches 64
typedef struct {
    float centre[3], half_size[3];
    float axis[3], spread, thickness;
} Cluster;

// A level of a PE's stack (sec. 1.5.1): consecutive patches, one a lane, from `patch` on. `visible`
// has a bit for each that may be seen.
typedef struct {
    int32_t patch, visible;
} Level;

// Projection parameters of one patch (sec. 1.5.2), a cache line; with its rectangle 72 bytes, "about
// 100" in sec. 1.6.
// An edge is (A, B, C) of eq. 1.2 as a moment: its value is the length by which the edge misses a
// proxel's ray, over the distance of the edge's nearer end; positive inside.
// depth is (A", B", C") of app. A.
typedef struct {
    float edge[4][3];
    float depth[3];
    int32_t patch;
} Projection;

// Bounding rectangle of one patch (app. B), apart from the rest: the sort by tiles reads nothing
// else. first | last << 16, of proxels.
typedef struct {
    uint32_t columns, rows;
} Rectangle;

// The most energetic of kReduceBlock shooters.
typedef struct {
    float energy;  // unshot flux over the bands' weights
    int32_t shooter;
} BlockSummary;

// Form factors in the making, [kind][patch], sums over the shooter's hemispheres: closed form times
// visible fraction v, closed form alone, and closed form times v (1 - v).
#define kVisibleFactor 0
#define kUnblockedFactor 1
#define kDoubtfulFactor 2
#define kFactorKinds 3

// After the patches' proxel counts: see choose_shooter.cl. The counts of a salvo's shooters lie
// stride + kCountsGap apart, as vectors ask.
#define kSpareCounts 3
#define kCountsGap 64

#ifndef __OPENCL_VERSION__
static_assert(sizeof(BlockSummary) == 8);
static_assert(sizeof(Shot) == 144);
static_assert(sizeof(GatherPoint) == 56);
static_assert(sizeof(RowPool) == 8);
static_assert(sizeof(Extent) == 8);
static_assert(sizeof(Cluster) == 44);
static_assert(sizeof(Level) == 8);
static_assert(sizeof(Projection) == 64);
static_assert(sizeof(Rectangle) == 8);
}  // namespace hemirad::device
#endif

#endif
