// First level of the sums over all patches that close a shot's analytic form factors: of the
// factors, and of the doubt about them. block_sums: [block][visible, doubtful].
#include "progress.clh"
#include "shared.h"
#include "sixteen_sums.clh"

static float block_sum(const __global float* values, int block) {
    real_v sums[ACCUMULATORS];
    for (int a = 0; a < ACCUMULATORS; ++a) sums[a] = (real_v)0.0f;
    for (int step = 0; step < kReduceBlock / LANES; ++step)
        sums[step % ACCUMULATORS] += load_v(block * kReduceBlock + step * LANES, values);
    return total_of(sums);
}

__kernel void add_up_factors(const __global Shot* shot, const __global float* factors, int stride,
                             __global float* block_sums) {
    if (!is_closing_row(shot)) return;
    const int pe = get_global_id(0), pe_count = get_global_size(0);
    for (int block = pe; block < stride / kReduceBlock; block += pe_count) {
        block_sums[2 * block] = block_sum(factors + kVisibleFactor * stride, block);
        block_sums[2 * block + 1] = block_sum(factors + kDoubtfulFactor * stride, block);
    }
}
