// Point-to-polygon factors from the hemispheres' centres miss the mean over the shooter where a
// patch is near. There the host knows the closed form from polygon to polygon; of the hemispheres
// only the visible fraction remains.
#include "progress.clh"
#include "shared.h"

__kernel void correct_near_pairs(const __global Shot* shot, const __global int* near_begin,
                                 const __global int* near_patch, const __global float* near_factor,
                                 int stride, __global float* factors) {
    if (!is_closing_row(shot)) return;
    const int end = near_begin[shot->shooter + 1];
    for (int k = near_begin[shot->shooter] + get_global_id(0); k < end; k += get_global_size(0)) {
        __global float* of_patch = factors + near_patch[k];
        const float unblocked = of_patch[kUnblockedFactor * stride];
        if (!(unblocked > 0.0f)) continue;
        const float correction = near_factor[k] * shot->part_count / unblocked;
        of_patch[kVisibleFactor * stride] *= correction;
        of_patch[kDoubtfulFactor * stride] *= correction;
    }
}
