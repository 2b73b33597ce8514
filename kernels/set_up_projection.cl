// Sec. 1.5.2: projection parameters. Each PE prepares the visible patches of its stack: shooter's
// frame, elliptic arcs (eq. 1.2), depth plane (app. A), bounding rectangle (app. B).
#include "clip.clh"
#include "patches.clh"
#include "progress.clh"

// How far the shooter lies in front of a patch's plane, by the corner that errs least. cull_patches
// has shown it to be more than kGridMargin.
static real_v height_over(Point normal, const Point* corner) {
    real_v height = -dot_v(normal, corner[0]), nearest = dot_v(corner[0], corner[0]);
    for (int k = 1; k < CORNERS; ++k) {
        const real_v squared = dot_v(corner[k], corner[k]);
        const int_v nearer = less_v(squared, nearest);
        nearest = choose_v(nearer, squared, nearest);
        height = choose_v(nearer, -dot_v(normal, corner[k]), height);
    }
    return fmax(height, (real_v)kGridMargin);
}

// -1/rho of app. A as a plane: the nearest patch has the smallest value.
static Point depth_plane(const __global Shot* shot, Point normal, real_v height) {
    return scaled_v(1.0f / height, rotated_into(shot, normal));
}

// Spencer's approximation (app. A): -1/rho of one point, for all proxels of a patch.
static Point constant_depth(Point centre) {
    const Point result = {-1.0f / sqrt(dot_v(centre, centre)), (real_v)0.0f, (real_v)0.0f};
    return result;
}

// An edge's plane with its displacement by kEdgeMargin of its reach for a unit. A repeated corner,
// or an edge that points at the shooter, bounds nothing above the horizon.
static Point relative_edge(Point plane, Point p, Point q) {
    Point result = scaled_v(1.0f / edge_reach(p, q), plane);
    result.z = choose_v(equal_v(dot_v(plane, plane), (real_v)0.0f), (real_v)1.0f, result.z);
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
    const float play = play_of(lane_of(bounds.distance, lane), lane_of(bounds.reach, lane));
    to->columns = proxel_range(lane_of(bounds.u_least, lane), lane_of(bounds.u_most, lane), play);
    to->rows = proxel_range(lane_of(bounds.v_least, lane), lane_of(bounds.v_most, lane), play);
}

__kernel void set_up_projection(const __global Shot* shot, const __global int* corners,
                                const __global float* normals, int stride, int depth,
                                const __global int* stack, const __global int* stack_height,
                                __global Projection* projections) {
    if (!is_projecting(shot)) return;
    const int pe = get_global_id(0);
    const int height = stack_height[pe];
    for (int level = 0; level < height; level += LANES) {
        const int count = min(LANES, height - level);
        int patches[LANES];
        take_level(stack + pe * depth + level, count, patches);
        Point corner[CORNERS], planes[CORNERS];
        gather_corners(shot, corners, stride, patches, corner);
        const Point normal = gathered_points(normals, stride, patches);
        const Point true_depth = depth_plane(shot, normal, height_over(normal, corner));
        turn_corners(shot, corner);
        for (int k = 0; k < CORNERS; ++k)
            planes[k] = edge_plane(corner[k], corner[(k + 1) % CORNERS]);
        const Bounds bounds = clipped_bounds(corner, planes);
        for (int k = 0; k < CORNERS; ++k)
            planes[k] = relative_edge(planes[k], corner[k], corner[(k + 1) % CORNERS]);
#ifdef DISTANCE_CONSTANT
        Point centre = corner[0];
        for (int k = 1; k < CORNERS; ++k) centre = sum_v(centre, corner[k]);
        const Point depth_of = constant_depth(scaled_v((real_v)(1.0f / CORNERS), centre));
#else
        const Point depth_of = true_depth;
#endif

        __global Projection* to = projections + pe * depth + level;
        for (int lane = 0; lane < count; ++lane)
            store_projection(to + lane, lane, patches[lane], planes, depth_of, bounds);
    }
}
