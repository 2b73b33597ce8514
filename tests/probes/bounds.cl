// ellipse_bounds.clh and clip.clh, shown to a test: the rectangle of one arc, and of a patch.
// bounds: least u, most u, least v, most v, of `count` arcs or patches each; ranges: columns, then
// rows.
#include "clip.clh"
#include "patches.clh"

static Point direction_of(Point a) {
    return scaled_v(1.0f / sqrt(dot_v(a, a)), a);
}

static Point plane_of(Point p, Point q) {
    return edge_plane(p, q, edge_reach(sqrt(dot_v(p, p)), sqrt(dot_v(q, q))));
}

static void store_bounds(Bounds bounds, real_v play, int count, int at, __global float* to,
                         __global int* ranges) {
    *real_vectors(to + at) = bounds.u_least;
    *real_vectors(to + count + at) = bounds.u_most;
    *real_vectors(to + 2 * count + at) = bounds.v_least;
    *real_vectors(to + 3 * count + at) = bounds.v_most;
    *int_vectors(ranges + at) = proxel_range(bounds.u_least, bounds.u_most, play);
    *int_vectors(ranges + count + at) = proxel_range(bounds.v_least, bounds.v_most, play);
}

__kernel void bound_arcs(const __global float* from, const __global float* to, int count,
                         __global float* result, __global int* ranges) {
    const int at = get_global_id(0) * LANES;
    const Point a = consecutive_points(from, count, at), b = consecutive_points(to, count, at);
    const Point plane = plane_of(a, b);
    Bounds bounds = no_bounds();
    include_direction(&bounds, direction_of(a), (int_v)-1);
    include_direction(&bounds, direction_of(b), (int_v)-1);
    include_extrema(&bounds, slopes_of(a, b), plane, (int_v)0, (int_v)-1);
    const real_v reach = edge_reach(sqrt(dot_v(a, a)), sqrt(dot_v(b, b)));
    const real_v squared = least_squared(a, b, plane, reach, (real_v)MAXFLOAT);
    store_bounds(bounds, play_of(reach, squared), count, at, result, ranges);
}

__kernel void bound_patches(const __global float* corners, int count, __global float* result,
                            __global int* ranges) {
    const int at = get_global_id(0) * LANES;
    Point corner[CORNERS], direction[CORNERS], planes[CORNERS];
    for (int k = 0; k < CORNERS; ++k) {
        corner[k] = consecutive_points(corners + 3 * k * count, count, at);
        direction[k] = direction_of(corner[k]);
    }
    real_v squared = MAXFLOAT, farthest = 0.0f;
    for (int k = 0; k < CORNERS; ++k) {
        const Point p = corner[k], q = corner[(k + 1) % CORNERS];
        const real_v reach = edge_reach(sqrt(dot_v(p, p)), sqrt(dot_v(q, q)));
        planes[k] = edge_plane(p, q, reach);
        squared = least_squared(p, q, planes[k], reach, squared);
        farthest = max(farthest, reach);
    }
    store_bounds(clipped_bounds(corner, direction, planes), play_of(farthest, squared), count, at,
                 result, ranges);
}
