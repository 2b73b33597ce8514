// Form factors that are exact where nothing hides a patch: its closed form, times the fraction of
// the proxels inside its outline that it owns. Counting alone (sec. 1.5.4) errs by the proxels that
// the outline cuts; here only the outlines of what hides a patch matter. Each PE takes the visible
// patches of its stack; the counts of the hemisphere are spent.
#include "patches.clh"
#include "plane.clh"
#include "point_to_polygon.clh"
#include "progress.clh"
#include "stacks.clh"

// What lies a ten-thousandth before a patch does not hide it: neighbours in one plane differ by
// rounding.
#define kSamePlane 1e-4f

static float3 normal_at(const __global float* normals, int stride, int patch) {
    return (float3)(normals[patch], normals[stride + patch], normals[2 * stride + patch]);
}

// Corner k of a patch as seen from the hemisphere's centre.
static float3 corner_at(const __global Shot* shot, const __global int* corners, int stride,
                        int patch, int k) {
    const __global int* at = corners + 3 * k * stride + patch;
    const int3 corner = (int3)(at[0], at[stride], at[2 * stride]);
    return kGridStep *
           convert_float3(corner - (int3)(shot->origin[0], shot->origin[1], shot->origin[2]));
}

// Whether the plane of `owner` cuts the way from the hemisphere's centre to `middle`.
static bool hides(const __global Shot* shot, const __global int* corners,
                  const __global float* normals, int stride, int owner, float3 middle) {
    const float3 normal = normal_at(normals, stride, owner);
    const float height = dot(normal, corner_at(shot, corners, stride, owner, 0));
    const float along = dot(normal, middle);
    return along < 0.0f && height > (1.0f - kSamePlane) * along;
}

// A patch that covers no proxel's centre is as visible as its middle, and this is hidden where
// whoever owns the proxel around it lies before it.
static float sub_proxel_visibility(const __global Shot* shot, const __global int* corners,
                                   const __global float* normals, int stride,
                                   const __global int* owners, int patch, float3 direction) {
    const float3 unit = normalize(direction);
    const int column = clamp((int)((unit.x + 1.0f) * (0.5f * RESOLUTION)), 0, RESOLUTION - 1);
    const int row = clamp((int)((unit.y + 1.0f) * (0.5f * RESOLUTION)), 0, RESOLUTION - 1);
    const int owner = owners[proxel_place(column, row)];
    if (owner >= stride || owner == patch) return 1.0f;
    float3 middle = 0.0f;
    for (int k = 0; k < CORNERS; ++k) middle += corner_at(shot, corners, stride, patch, k);
    return hides(shot, corners, normals, stride, owner, middle / (float)CORNERS) ? 0.0f : 1.0f;
}

__kernel void estimate_form_factors(const __global Shot* shot, const __global int* corners,
                                    const __global float* normals, int stride, int depth,
                                    const __global Level* stack, const __global int* stack_height,
                                    const __global int* owners, __global int* proxel_count,
                                    __global int* covered_count, __global float* factors) {
    if (!is_projecting(shot)) return;
    const int pe = own_stack();
    const __global Level* level = stack + pe * (depth / LANES);
    const __global Level* end = level + stack_height[pe];
    int owned = 0;
    for (; level < end; ++level) {
        Point corner[CORNERS];
        relative_corners(shot, corners, stride, level->patch, corner);
        turn_corners(shot, corner);
        const real_v unblocked = point_to_polygon(corner);
        Point middle = corner[0];
        for (int k = 1; k < CORNERS; ++k) middle = sum_v(middle, corner[k]);

        for (int lane = 0; lane < LANES; ++lane) {
            if ((level->visible >> lane & 1) == 0) continue;
            const int patch = level->patch + lane;
            const int covered = covered_count[patch], visible = proxel_count[patch];
            const float factor = lane_of(unblocked, lane);
            const float3 direction = (float3)(lane_of(middle.x, lane), lane_of(middle.y, lane),
                                              lane_of(middle.z, lane));
            const float fraction =
                covered > 0 ? (float)visible / covered
                            : sub_proxel_visibility(shot, corners, normals, stride, owners, patch,
                                                    direction);
            owned += visible;
            covered_count[patch] = 0;
            proxel_count[patch] = 0;
            factors[kVisibleFactor * stride + patch] += factor * fraction;
            factors[kUnblockedFactor * stride + patch] += factor;
            factors[kDoubtfulFactor * stride + patch] += factor * fraction * (1.0f - fraction);
        }
    }
    if (owned != 0) atomic_add(proxel_count + stride + 2, owned);
}
