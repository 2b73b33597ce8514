// point_to_polygon.clh, shown to a test. corners: [corner][axis][count], of the shooter's frame.
#include "patches.clh"
#include "point_to_polygon.clh"

__kernel void point_factors(const __global float* corners, int count, __global float* factors) {
    const int at = get_global_id(0) * LANES;
    Point corner[CORNERS];
    for (int k = 0; k < CORNERS; ++k)
        corner[k] = consecutive_points(corners + 3 * k * count, count, at);
    *real_vectors(factors + at) = point_to_polygon(corner);
}

__kernel void angles(const __global float* y, const __global float* x, __global float* result) {
    const int at = get_global_id(0) * LANES;
    *real_vectors(result + at) = angle_over_sine(load_v(at, y), load_v(at, x));
}
