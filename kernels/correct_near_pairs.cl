// Point-to-polygon factors from the hemispheres' centres miss the mean over the shooter where a
// patch is near. There the host knows the closed form from polygon to polygon; of the hemispheres
// only the visible fraction remains.
#include "progress.clh"
#include "shared.h"

__kernel void correct_near_pairs(const __global Shot* salvo, const __global int* near_begin,
                                 const __global int* near_patch, const __global float* near_factor,
                                 int stride, __global float* all_factors) {
    const int station = get_group_id(0);
    const int member = member_at(salvo, closing_members(salvo), station);
    if (member < 0) return;
    const __global Shot* shot = salvo + member;
    __global float* factors = all_factors + station * kFactorKinds * stride;
    const int end = near_begin[shot->shooter + 1];
    for (int k = near_begin[shot->shooter] + get_local_id(0); k < end; k += get_local_size(0)) {
        __global float* of_patch = factors + near_patch[k];
        const float unblocked = of_patch[kUnblockedFactor * stride];
        if (!(unblocked > 0.0f)) continue;
        const float correction = near_factor[k] * shot->part_count / unblocked;
        of_patch[kVisibleFactor * stride] *= correction;
        of_patch[kDoubtfulFactor * stride] *= correction;
    }
}
