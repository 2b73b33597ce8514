// Sec. 1.5.2: projection parameters. Each PE prepares the visible patches of its stack: shooter's
// frame, elliptic arcs (eq. 1.2), depth plane (app. A), bounding rectangle (app. B).
#include "clip.clh"
#include "patches.clh"

// -1/rho of app. A as a plane: the nearest patch has the smallest value.
static Point depth_plane(const __global Shot* shot, Point normal, Point corner) {
    return scaled_v(-1.0f / dot_v(normal, corner), rotated_into(shot, normal));
}

// Spencer's approximation (app. A): -1/rho of one point, for all proxels of a patch.
static Point constant_depth(Point centre) {
    const Point result = {-1.0f / sqrt(dot_v(centre, centre)), (real_v)0.0f, (real_v)0.0f};
    return result;
}

static void store_point(Point point, int lane, __global float* to) {
    to[0] = lane_of(point.x, lane);
    to[1] = lane_of(point.y, lane);
    to[2] = lane_of(point.z, lane);
}

static void store_projection(__global Projection* to, int lane, int patch, const Point* planes,
                             Point depth, Bounds bounds) {
    for (int k = 0; k < CORNERS; ++k) store_point(planes[k], lane, to->edge[k]);
    store_point(depth, lane, to->depth);
    to->patch = patch;
    const float distance = lane_of(bounds.distance, lane);
    to->columns = proxel_range(lane_of(bounds.u_least, lane), lane_of(bounds.u_most, lane),
                               distance);
    to->rows = proxel_range(lane_of(bounds.v_least, lane), lane_of(bounds.v_most, lane), distance);
}

__kernel void set_up_projection(const __global Shot* shot, const __global float* corners,
                                const __global float* normals, int stride, int depth,
                                const __global int* stack, const __global int* stack_height,
                                __global Projection* projections) {
    if (shot->status != kRunning) return;
    const int pe = get_global_id(0);
    const int height = stack_height[pe];
    for (int level = 0; level < height; level += LANES) {
        const int count = min(LANES, height - level);
        int patches[LANES];
        take_level(stack + pe * depth + level, count, patches);
        Point corner[CORNERS], planes[CORNERS];
        gather_corners(shot, corners, stride, patches, corner);
        for (int k = 0; k < CORNERS; ++k)
            planes[k] = edge_plane(corner[k], corner[(k + 1) % CORNERS]);
#ifdef DISTANCE_CONSTANT
        Point centre = corner[0];
        for (int k = 1; k < CORNERS; ++k) centre = sum_v(centre, corner[k]);
        const Point depth_of = constant_depth(scaled_v((real_v)(1.0f / CORNERS), centre));
#else
        const Point depth_of = depth_plane(
            shot, gathered_points(normals, stride, patches),
            relative_to(shot, gathered_points(corners, stride, patches)));
#endif
        const Bounds bounds = clipped_bounds(corner, planes);

        __global Projection* to = projections + pe * depth + level;
        for (int lane = 0; lane < count; ++lane)
            store_projection(to + lane, lane, patches[lane], planes, depth_of, bounds);
    }
}
