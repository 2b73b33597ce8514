// Closure of analytic form factors: what they and the outside lack to 1 goes to those whose visible
// fraction is in doubt, in proportion to F v (1 - v): least squares with these as weights. So a
// patch that nothing hides keeps its closed form. Where the doubt is less than what lacks, all are
// scaled alike. The outside is counted; its v is its own share of the disk.
#include "progress.clh"
#include "shared.h"

__kernel void spread_residual(__global Shot* salvo, const __global float* all_sums,
                              int block_count, const __global int* proxel_counts, int stride,
                              int disk_proxels) {
    __local float visible[REDUCE_PES], doubtful[REDUCE_PES];
    const int pe = get_local_id(0), station = get_group_id(0);
    const __global float* block_sums = all_sums + 2 * station * block_count;
    const __global int* proxel_count = proxel_counts + station * (stride + kCountsGap);
    float visible_sum = 0.0f, doubtful_sum = 0.0f;
    for (int block = pe; block < block_count; block += REDUCE_PES) {
        visible_sum += block_sums[2 * block];
        doubtful_sum += block_sums[2 * block + 1];
    }
    visible[pe] = visible_sum;
    doubtful[pe] = doubtful_sum;
    barrier(CLK_LOCAL_MEM_FENCE);

    // No work-item may leave before a barrier, see prefix_sum.cl.
    const int member = member_at(salvo, closing_members(salvo), station);
    if (pe == 0 && member >= 0) {
        __global Shot* shot = salvo + member;
        for (int other = 1; other < REDUCE_PES; ++other) {
            visible[0] += visible[other];
            doubtful[0] += doubtful[other];
        }
        const float per_part = 1.0f / max(shot->part_count, 1u);
        const float outside = proxel_count[stride] * (per_part / disk_proxels);
        const float outside_doubt = outside * (1.0f - outside);
        const float sum = visible[0] * per_part + outside;
        const float doubt = doubtful[0] * per_part + outside_doubt;
        const bool spread = fabs(1.0f - sum) <= doubt;
        const float share = spread && doubt > 0.0f ? (1.0f - sum) / doubt : 0.0f;
        const float scale = spread || !(sum > 0.0f) ? 1.0f : 1.0f / sum;
        shot->factor_scale = scale * per_part;
        shot->residual_share = share * per_part;
        shot->escaped_fraction = scale * outside + share * outside_doubt;
    }
}
