// Sec. 1.5.1: elimination of trivially invisible patches. Each PE tests the patches it manages,
// pe * depth and on, LANES at a time, and stacks those among which one may be visible, in their
// order. Of most clusters all or none are, which needs no look at each.
#include "patches.clh"
#include "progress.clh"
#include "stacks.clh"

// Rooms that no light comes to from the shooter's are not looked into: between proxels, or where two
// patches claim one, what shuts them off may miss a ray.
static int_v is_reached(const __global Shot* shot, const __global int* rooms, int patch) {
    const int reached = shot->reached;
    return reached == -1 ? (int_v)-1 : ~equal_v(load_v(patch, rooms) & reached, (int_v)0);
}

// Whether a corner at `squared` distance shows by its `height` that it lies before a plane.
static int_v is_before(real_v height, real_v squared) {
    const real_v sure = height - kGridMargin;
    return less_v((real_v)0.0f, sure) &
           less_v(squared * (kPlaneMargin * kPlaneMargin), sure * sure);
}

static int_v in_plane_of(const __global Shot* shot, const __global int* planes, int patch) {
    const int own = shot->plane;
    return own < 0 ? (int_v)0 : equal_v(load_v(patch, planes), (int_v)own);
}

// Faces the shooter, and has a corner in front of it. Any corner may show on which side of a plane
// the patch is: the nearest one errs least.
static int_v faces_from_in_front(const __global Shot* shot, const __global int* corners,
                                 const __global float* normals, int stride, int patch) {
    const Point normal = consecutive_points(normals, stride, patch);
    Point corner[CORNERS];
    relative_corners(shot, corners, stride, patch, corner);
    int_v facing = 0, in_front = 0;
    for (int k = 0; k < CORNERS; ++k) {
        const real_v squared = dot_v(corner[k], corner[k]);
        facing |= is_before(-dot_v(normal, corner[k]), squared);
        in_front |= is_before(dot_axis(shot->normal, corner[k]), squared);
    }
    return facing & in_front;
}

// What of a cluster's patches is_before a plane, all corners of which lie from `least` to `most`
// above it: none, some, or all. kPlaneMargin of the scene's diagonal is 1.2e-6, and what rounding
// does to the two is less.
#define kClusterMargin 4e-6f
#define kNone 0
#define kSome 1
#define kAll 2
static int share_before(float least, float most) {
    return least > kClusterMargin ? kAll : most < -kClusterMargin ? kNone : kSome;
}

static int share_visible(const __global Shot* shot, const __global Cluster* cluster) {
    const float3 axis = vload3(0, cluster->axis);
    const float3 origin =
        kGridStep * convert_float3((int3)(shot->origin[0], shot->origin[1], shot->origin[2]));
    const float3 centre = vload3(0, cluster->centre) - origin;
    const float facing = -dot(axis, centre);
    const float3 half_size = vload3(0, cluster->half_size);
    const float facing_by =
        cluster->thickness + cluster->spread * (length(centre) + length(half_size));
    const float3 upwards = vload3(0, shot->normal);
    const float above = dot(upwards, centre), above_by = dot(fabs(upwards), half_size);
    return min(share_before(facing - facing_by, facing + facing_by),
               share_before(above - above_by, above + above_by));
}

__kernel void cull_patches(const __global Shot* salvo, const __global Cluster* clusters,
                           const __global int* corners, const __global float* normals,
                           const __global int* planes, const __global int* rooms, int stride,
                           int depth, __global Level* stack,
                           __global int* stack_height) {
    const Stack own = own_stack(salvo);
    if (own.member < 0) return;
    const __global Shot* shot = salvo + own.member;
    const int end = min((own.pe + 1) * depth, stride);
    __global Level* top = stack + own.place * (depth / LANES);
    int height = 0;
    for (int first = own.pe * depth; first < end; first += kClusterPatches) {
        const int share = share_visible(shot, clusters + first / kClusterPatches);
        if (share == kNone) continue;
        for (int patch = first; patch < first + kClusterPatches; patch += LANES) {
            int_v visible =
                ~in_plane_of(shot, planes, patch) & is_reached(shot, rooms, patch);
            if (share == kSome && any_v(visible))
                visible &= faces_from_in_front(shot, corners, normals, stride, patch);
            const Level level = {patch, bits_of(visible)};
            if (level.visible != 0) top[height++] = level;
        }
    }
    stack_height[own.place] = height;
}
