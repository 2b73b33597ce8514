// Sec. 1.5.1: elimination of trivially invisible patches. Each PE tests the patches it manages,
// pe * depth and on, and sorts its stack so that the visible ones lie on top, in their order.
#include "patches.clh"
#include "progress.clh"

// Whether a corner at `squared` distance shows by its `height` that it lies before a plane.
static int_v is_before(real_v height, real_v squared) {
    const real_v sure = height - kGridMargin;
    return less_v((real_v)0.0f, sure) &
           less_v(squared * (kPlaneMargin * kPlaneMargin), sure * sure);
}

// Does not lie in the shooter's plane, faces the shooter, and has a corner in front of it. Any
// corner may show on which side of a plane the patch is: the nearest one errs least.
static int_v potentially_visible(const __global Shot* shot, const __global int* corners,
                                 const __global float* normals, const __global int* planes,
                                 int stride, int patch) {
    const Point normal = consecutive_points(normals, stride, patch);
    int_v facing = 0, in_front = 0;
    for (int k = 0; k < CORNERS; ++k) {
        const Point corner =
            relative_to(shot, consecutive_corners(corners + 3 * k * stride, stride, patch));
        const real_v squared = dot_v(corner, corner);
        facing |= is_before(-dot_v(normal, corner), squared);
        in_front |= is_before(dot_axis(shot->normal, corner), squared);
    }
    const int own = shot->plane;
    const int_v coplanar = own < 0 ? (int_v)0 : equal_v(load_v(patch, planes), (int_v)own);
    return facing & in_front & ~coplanar;
}

__kernel void cull_patches(const __global Shot* shot, const __global int* corners,
                           const __global float* normals, const __global int* planes,
                           int stride, int depth,
                           __global int* stack, __global int* stack_height) {
    if (!is_projecting(shot)) return;
    const int pe = get_global_id(0);
    const int end = min((pe + 1) * depth, stride);
    __global int* top = stack + pe * depth;
    int height = 0;
    for (int patch = pe * depth; patch < end; patch += LANES) {
        const int_v visible =
            potentially_visible(shot, corners, normals, planes, stride, patch);
        if (!any_v(visible)) continue;
        for (int lane = 0; lane < LANES; ++lane) {
            top[height] = patch + lane;
            height -= int_lane_of(visible, lane);
        }
    }
    stack_height[pe] = height;
}
