// Form factors that are exact where nothing hides a patch: its closed form, times the fraction of
// the proxels inside its outline that it owns. Counting alone (sec. 1.5.4) errs by the proxels that
// the outline cuts; here only the outlines of what hides a patch matter. Each PE takes the visible
// patches of its stack, LANES at a time; the counts of the hemisphere are spent.
#include "patches.clh"
#include "plane.clh"
#include "point_to_polygon.clh"
#include "progress.clh"
#include "stacks.clh"

// What lies a ten-thousandth before a patch does not hide it: neighbours in one plane differ by
// rounding.
#define kSamePlane 1e-4f

typedef struct {
    const __global int *corners, *planes;
    const __global float* normals;
    const __global uchar* rims;
    int stride;
} Patches;

static float3 normal_at(const Patches* patches, int patch) {
    const __global float* normals = patches->normals + patch;
    return (float3)(normals[0], normals[patches->stride], normals[2 * patches->stride]);
}

// A corner of a patch as seen from the hemisphere's centre.
static float3 corner_at(const __global Shot* shot, const Patches* patches, int k, int patch) {
    const __global int* corners = patches->corners + 3 * k * patches->stride + patch;
    const int3 corner =
        (int3)(corners[0], corners[patches->stride], corners[2 * patches->stride]);
    return kGridStep *
           convert_float3(corner - (int3)(shot->origin[0], shot->origin[1], shot->origin[2]));
}

// Whether a direction passes a patch on the inner side of those of its edges at which its plane
// ends: within it, or within neighbours in its plane.
static bool is_within_rims(const __global Shot* shot, const Patches* patches, int patch,
                           float3 direction) {
    const int rims = patches->rims[patch];
    if (rims == 0) return true;
    float3 corner[CORNERS];
    for (int k = 0; k < CORNERS; ++k) corner[k] = corner_at(shot, patches, k, patch);
    for (int k = 0; k < CORNERS; ++k) {
        const float3 next = corner[k + 1 < CORNERS ? k + 1 : 0];
        if ((rims >> k & 1) != 0 && dot(cross(corner[k], next), direction) > 0.0f) return false;
    }
    return true;
}

// Whether `owner` cuts the way from the hemisphere's centre to `middle`, a point of `patch`.
static bool hides(const __global Shot* shot, const Patches* patches, int owner, int patch,
                  float3 middle) {
    const int plane = patches->planes[owner];
    if (plane >= 0 && plane == patches->planes[patch]) return false;
    const float3 normal = normal_at(patches, owner);
    const float along = dot(normal, middle);
    if (along >= 0.0f) return false;
    const float height = dot(normal, corner_at(shot, patches, 0, owner));
    return height > (1.0f - kSamePlane) * along && is_within_rims(shot, patches, owner, middle);
}

static Point middle_of(const Point* corner) {
    Point middle = corner[0];
    for (int k = 1; k < CORNERS; ++k) middle = sum_v(middle, corner[k]);
    return scaled_v((real_v)(1.0f / CORNERS), middle);
}

// The last proxel whose centre a direction of the shooter's frame has passed, along one axis.
static int_v proxel_before(real_v along, real_v distance) {
    const int_v place = to_int_v(fma(along / distance + 1.0f, 0.5f * RESOLUTION, -0.5f));
    return clamp(place, (int_v)0, (int_v)(RESOLUTION - 2));
}

// A patch that covers no proxel's centre is as visible as its middle. What hides this owns one of
// the four proxels around it, where it is wider than a proxel and the middle not at its corner. A
// bit for each of `asked` patches that is hidden.
static int hidden_middles(const __global Shot* shot, const Patches* patches,
                          const __global int* owners, int patch, int asked, Point middle,
                          Point turned) {
    const real_v distance = sqrt(dot_v(turned, turned));
    const int_v column = proxel_before(turned.x, distance), row = proxel_before(turned.y, distance);
    int_v place[4];
    UNROLLED for (int k = 0; k < 4; ++k) place[k] = proxel_places(column + (k & 1), row + (k >> 1));
    int hidden = 0;
    for (int rest = asked; rest != 0; rest &= rest - 1) {
        const int lane = lowest_bit(rest), own = patch + lane;
        const float3 at = (float3)(lane_of(middle.x, lane), lane_of(middle.y, lane),
                                   lane_of(middle.z, lane));
        int last = own;
        for (int k = 0; k < 4; ++k) {
            const int owner = owners[int_lane_of(place[k], lane)];
            if (owner == last || owner == own || owner >= patches->stride) continue;
            last = owner;
            if (!hides(shot, patches, owner, own, at)) continue;
            hidden |= 1 << lane;
            break;
        }
    }
    return hidden;
}

static void add_to(__global float* sums, real_v value) {
    *real_vectors(sums) = load_v(0, sums) + value;
}

__kernel void estimate_form_factors(const __global Shot* salvo, const __global int* corners,
                                    const __global float* normals, const __global int* planes,
                                    const __global uchar* rims, int stride, int depth,
                                    const __global Level* stack, const __global int* stack_height,
                                    const __global int* owners, __global int* proxel_counts,
                                    __global int* covered_counts, __global float* factors) {
    const Stack own = own_stack(salvo);
    if (own.member < 0) return;
    const __global Shot* shot = salvo + own.member;
    const Patches patches = {corners, planes, normals, rims, stride};
    const __global int* plane = owners + own.station * TILE_COUNT * TILE_VECTORS * LANES;
    __global int* proxel_count = proxel_counts + own.station * (stride + kCountsGap);
    const __global Level* level = stack + own.place * (depth / LANES);
    const __global Level* end = level + stack_height[own.place];
    int_v owned = (int_v)0;
    for (; level < end; ++level) {
        fetch_patches_ahead(corners, normals, stride, level + 1, end);
        Point corner[CORNERS];
        relative_corners(shot, corners, stride, level->patch, corner);
        const Point middle = middle_of(corner);
        turn_corners(shot, corner);
        const int_v is_visible = lanes_of(level->visible);
        const real_v unblocked =
            choose_v(is_visible, point_to_polygon(corner), (real_v)0.0f);

        __global int* count = proxel_count + level->patch;
        __global int* covered = covered_counts + own.station * stride + level->patch;
        const int_v visible = load_v(0, count), all = load_v(0, covered);
        const int asked = level->visible & bits_of(all == 0);
        real_v fraction = to_real_v(visible) / to_real_v(max(all, (int_v)1));
        if (asked != 0) {
            const int hidden = hidden_middles(shot, &patches, plane, level->patch, asked,
                                              middle, middle_of(corner));
            fraction = choose_v(lanes_of(asked & ~hidden), (real_v)1.0f, fraction);
        }
        owned += visible;
        *int_vectors(count) = (int_v)0;
        *int_vectors(covered) = (int_v)0;
        const real_v seen = unblocked * fraction;
        __global float* sums = factors + own.station * kFactorKinds * stride + level->patch;
        add_to(sums + kVisibleFactor * stride, seen);
        add_to(sums + kUnblockedFactor * stride, unblocked);
        add_to(sums + kDoubtfulFactor * stride, seen * (1.0f - fraction));
    }
    int total = 0;
    for (int lane = 0; lane < LANES; ++lane) total += int_lane_of(owned, lane);
    if (total != 0) atomic_add(proxel_count + stride + 2, total);
}
