// Sec. 1.5.1: elimination of trivially invisible patches. Each PE tests the patches it manages,
// pe * depth and on, and sorts its stack so that the visible ones lie on top, in their order.
#include "patches.clh"

// Faces the shooter, and has a corner in front of it.
static int_v potentially_visible(const __global Shot* shot, const __global float* corners,
                                 const __global float* normals, int stride, int patch) {
    const Point normal = consecutive_points(normals, stride, patch);
    const Point first = relative_to(shot, consecutive_points(corners, stride, patch));
    real_v highest = dot_axis(shot->normal, first);
    for (int k = 1; k < CORNERS; ++k) {
        const Point corner = relative_to(
            shot, consecutive_points(corners + 3 * k * stride, stride, patch));
        const real_v height = dot_axis(shot->normal, corner);
        highest = choose_v(less_v(highest, height), height, highest);
    }
    const int_v facing = less_v(dot_v(normal, first), (real_v)-kPlaneMargin);
    return facing & less_v((real_v)kPlaneMargin, highest);
}

__kernel void cull_patches(const __global Shot* shot, const __global float* corners,
                           const __global float* normals, int stride, int depth,
                           __global int* stack, __global int* stack_height) {
    if (shot->status != kRunning) return;
    const int pe = get_global_id(0);
    const int end = min((pe + 1) * depth, stride);
    __global int* top = stack + pe * depth;
    int height = 0;
    for (int patch = pe * depth; patch < end; patch += LANES) {
        const int_v visible = potentially_visible(shot, corners, normals, stride, patch);
        if (!any_v(visible)) continue;
        for (int lane = 0; lane < LANES; ++lane) {
            top[height] = patch + lane;
            height -= int_lane_of(visible, lane);
        }
    }
    stack_height[pe] = height;
}
