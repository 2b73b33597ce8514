// First level of the sums over all patches that close a shot's analytic form factors: of the
// factors, and of the doubt about them. block_sums: [station][block][visible, doubtful].
#include "blocks.clh"
#include "progress.clh"
#include "shared.h"

static float block_sum(const __global float* values, int block) {
    real_v sums[ACCUMULATORS];
    for (int a = 0; a < ACCUMULATORS; ++a) sums[a] = (real_v)0.0f;
    for (int step = 0; step < kReduceBlock / LANES; ++step)
        sums[step % ACCUMULATORS] += load_v(block * kReduceBlock + step * LANES, values);
    return total_of(sums);
}

__kernel void add_up_factors(const __global Shot* salvo, const __global float* all_factors,
                             int stride, __global float* all_sums) {
    const Part own = own_part(salvo, closing_members(salvo));
    if (own.member < 0) return;
    const int block_count = stride / kReduceBlock;
    const int pe = own.share * get_local_size(0) + get_local_id(0);
    const int pe_count = get_global_size(0) / SALVO;
    const __global float* factors = all_factors + own.station * kFactorKinds * stride;
    __global float* block_sums = all_sums + 2 * own.station * block_count;
    const Blocks blocks = own_blocks(pe, pe_count, block_count);
    for (int block = blocks.first; block < blocks.end; ++block) {
        block_sums[2 * block] = block_sum(factors + kVisibleFactor * stride, block);
        block_sums[2 * block + 1] = block_sum(factors + kDoubtfulFactor * stride, block);
    }
}
