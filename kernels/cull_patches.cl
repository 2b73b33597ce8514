// Sec. 1.5.1: elimination of trivially invisible patches. Each PE tests the patches it manages,
// pe * depth and on, LANES at a time, and stacks those among which one may be visible, in their
// order.
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
    Point corner[CORNERS];
    relative_corners(shot, corners, stride, patch, corner);
    int_v facing = 0, in_front = 0;
    for (int k = 0; k < CORNERS; ++k) {
        const real_v squared = dot_v(corner[k], corner[k]);
        facing |= is_before(-dot_v(normal, corner[k]), squared);
        in_front |= is_before(dot_axis(shot->normal, corner[k]), squared);
    }
    const int own = shot->plane;
    const int_v coplanar = own < 0 ? (int_v)0 : equal_v(load_v(patch, planes), (int_v)own);
    return facing & in_front & ~coplanar;
}

__kernel void cull_patches(const __global Shot* shot, const __global int* corners,
                           const __global float* normals, const __global int* planes,
                           int stride, int depth,
                           __global Level* stack, __global int* stack_height) {
    if (!is_projecting(shot)) return;
    const int pe = get_global_id(0);
    const int end = min((pe + 1) * depth, stride);
    __global Level* top = stack + pe * (depth / LANES);
    int height = 0;
    for (int patch = pe * depth; patch < end; patch += LANES) {
        const Level level = {
            patch,
            bits_of(potentially_visible(shot, corners, normals, planes, stride, patch))};
        if (level.visible != 0) top[height++] = level;
    }
    stack_height[pe] = height;
}
