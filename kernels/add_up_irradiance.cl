// Final gather (ours), second level: a point's irradiance, the sum of what all blocks of patches send
// it. One group a station and band. block_sums: [station][band][block]; irradiance: [point][band].
// The station's counts that no patch has are spent.
#include "progress.clh"
#include "shared.h"

__kernel void add_up_irradiance(const __global Shot* salvo, const __global float* all_sums,
                                int block_count, int band_count, __global int* proxel_counts,
                                int stride, __global float* irradiance) {
    __local float sums[REDUCE_PES];
    const int pe = get_local_id(0), group = get_group_id(0);
    const int station = group / band_count, band = group % band_count;
    const __global float* block_sums = all_sums + group * block_count;
    float sum = 0.0f;
    for (int block = pe; block < block_count; block += REDUCE_PES) sum += block_sums[block];
    sums[pe] = sum;
    barrier(CLK_LOCAL_MEM_FENCE);

    // No work-item may leave before a barrier, see prefix_sum.cl.
    const int member = member_at(salvo, closing_members(salvo), station);
    if (pe == 0 && member >= 0) {
        for (int other = 1; other < REDUCE_PES; ++other) sum += sums[other];
        irradiance[salvo[member].shooter * band_count + band] = sum;
        __global int* spare_counts = proxel_counts + station * (stride + kCountsGap) + stride;
        for (int kind = 0; band == 0 && kind < kSpareCounts; ++kind) spare_counts[kind] = 0;
    }
}
