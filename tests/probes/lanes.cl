// lanes.clh, shown to a test: every operation on the values of two arrays, [operation][count].
#include "lanes.clh"

__kernel void operate(const __global float* a, const __global float* b, const __global int* index,
                      int count, __global int* result) {
    const int at = get_global_id(0) * LANES;
    const real_v x = load_v(at, a), y = load_v(at, b);
    const int_v less = less_v(x, y);

    *int_vectors(result + at) = less;
    *int_vectors(result + count + at) = as_int_v(choose_v(less, x, y));
    *int_vectors(result + 2 * count + at) = lanes_of(bits_of(less));
    *int_vectors(result + 3 * count + at) = at + LANE_INDEX;
    *int_vectors(result + 4 * count + at) = as_int_v(to_real_v(load_v(at, index)));
    for (int lane = 0; lane < LANES; ++lane) {
        result[5 * count + at + lane] = as_int(lane_of(x, lane));
        result[6 * count + at + lane] = int_lane_of(less, lane);
        result[7 * count + at + lane] = any_v(less) != 0;
        result[8 * count + at + lane] = bits_of(less) & 1 << lane;
    }
}
