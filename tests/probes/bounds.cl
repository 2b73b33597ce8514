// ellipse_bounds.clh and clip.clh, shown to a test: the rectangle of one arc, and of a patch.
// bounds: least u, most u, least v, most v, distance, of `count` arcs or patches each; ranges:
// columns, then rows.
#include "clip.clh"
#include "patches.clh"

static void store_bounds(Bounds bounds, int count, int at, __global float* to,
                         __global uint* ranges) {
    *real_vectors(to + at) = bounds.u_least;
    *real_vectors(to + count + at) = bounds.u_most;
    *real_vectors(to + 2 * count + at) = bounds.v_least;
    *real_vectors(to + 3 * count + at) = bounds.v_most;
    *real_vectors(to + 4 * count + at) = bounds.distance;
    for (int lane = 0; lane < LANES; ++lane) {
        const float play = play_of(lane_of(bounds.distance, lane), lane_of(bounds.reach, lane));
        ranges[at + lane] =
            proxel_range(lane_of(bounds.u_least, lane), lane_of(bounds.u_most, lane), play);
        ranges[count + at + lane] =
            proxel_range(lane_of(bounds.v_least, lane), lane_of(bounds.v_most, lane), play);
    }
}

__kernel void bound_arcs(const __global float* from, const __global float* to, int count,
                         __global float* result, __global uint* ranges) {
    const int at = get_global_id(0) * LANES;
    const Point a = consecutive_points(from, count, at), b = consecutive_points(to, count, at);
    Bounds bounds = no_bounds();
    bounds.reach = edge_reach(a, b);
    include_arc(&bounds, a, b, edge_plane(a, b), (int_v)-1);
    store_bounds(bounds, count, at, result, ranges);
}

__kernel void bound_patches(const __global float* corners, int count, __global float* result,
                            __global uint* ranges) {
    const int at = get_global_id(0) * LANES;
    Point corner[CORNERS], planes[CORNERS];
    for (int k = 0; k < CORNERS; ++k)
        corner[k] = consecutive_points(corners + 3 * k * count, count, at);
    for (int k = 0; k < CORNERS; ++k)
        planes[k] = edge_plane(corner[k], corner[(k + 1) % CORNERS]);
    store_bounds(clipped_bounds(corner, planes), count, at, result, ranges);
}
