// hemisphere.clh, shown to a test: edges' planes and what they claim. Points: [axis][count].
#include "hemisphere.clh"
#include "patches.clh"

static Point plane_of(Point p, Point q) {
    return edge_plane(p, q, edge_reach(sqrt(dot_v(p, p)), sqrt(dot_v(q, q))));
}

static void store_points(Point point, int stride, int at, __global float* to) {
    *real_vectors(to + at) = point.x;
    *real_vectors(to + stride + at) = point.y;
    *real_vectors(to + 2 * stride + at) = point.z;
}

__kernel void edge_planes(const __global float* from, const __global float* to, int count,
                          __global float* planes) {
    const int at = get_global_id(0) * LANES;
    store_points(plane_of(consecutive_points(from, count, at), consecutive_points(to, count, at)),
                 count, at, planes);
}

// -1 where a direction of the shooter's frame lies inside every edge of its patch, with the margin
// and in the order of project_patches. corners: [corner][axis][count], grid steps.
__kernel void claims(const __global Shot* shot, const __global int* corners,
                     const __global float* directions, int count, __global int* claimed) {
    const int at = get_global_id(0) * LANES;
    const Point x = consecutive_points(directions, count, at);
    Point corner[CORNERS];
    for (int k = 0; k < CORNERS; ++k)
        corner[k] = rotated_into(
            shot, relative_to(shot, consecutive_corners(corners + 3 * k * count, count, at)));
    int_v outside = 0;
    for (int k = 0; k < CORNERS; ++k) {
        const Point plane = plane_of(corner[k], corner[(k + 1) % CORNERS]);
        const real_v along_u = fma(plane.x, x.x, (real_v)kEdgeMargin);
        outside |= as_int_v(fma(plane.z, x.z, fma(plane.y, x.y, along_u)));
    }
    *int_vectors(claimed + at) = ~(outside >> 31);
}
