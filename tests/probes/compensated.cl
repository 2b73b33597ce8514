// compensated.clh, shown to a test: LANES sums of `count` values each, [value][lane].
#include "compensated.clh"

__kernel void add_all(const __global float* values, int count, __global float* sums,
                      __global float* rests) {
    real_v sum = (real_v)0.0f, rest = (real_v)0.0f;
    for (int i = 0; i < count; ++i) add_compensated(&sum, &rest, load_v(i * LANES, values));
    *real_vectors(sums) = sum;
    *real_vectors(rests) = rest;
}
