// Final gather (ours), first level: what blocks of patches send to the points that a salvo looks from.
// E = sum over patches of F B: a form factor from a point to a patch is what of the patch's radiosity
// arrives there. The form factors are spent.
// radiosity: [band][patch]; block_sums: [station][band][block].
#include "blocks.clh"
#include "form_factors.clh"
#include "progress.clh"

// Of a block, closed; whether there are any but 0.
static bool take_block(const __global Shot* shot, __global int* proxel_count, int disk_proxels,
                       __global float* factors, int stride, int block, real_v* form_factor) {
    int_v any = (int_v)0;
    int owned = 0;
    for (int step = 0; step < BLOCK_VECTORS; ++step) {
        const int patch = block * kReduceBlock + step * LANES;
#ifdef FORM_FACTOR_ANALYTIC
        form_factor[step] = take_form_factors(shot, factors, stride, patch);
#else
        form_factor[step] = take_counts(proxel_count, disk_proxels, patch, &owned);
#endif
        any |= less_v((real_v)0.0f, form_factor[step]);
    }
    return any_v(any);
}

static float sent_by_block(const real_v* form_factor, const __global float* radiosity, int block) {
    real_v sums[ACCUMULATORS];
    for (int a = 0; a < ACCUMULATORS; ++a) sums[a] = (real_v)0.0f;
    for (int step = 0; step < BLOCK_VECTORS; ++step)
        sums[step % ACCUMULATORS] =
            fma(form_factor[step], load_v(block * kReduceBlock + step * LANES, radiosity),
                sums[step % ACCUMULATORS]);
    return total_of(sums);
}

__kernel void gather_irradiance(const __global Shot* salvo, __global int* proxel_counts,
                                int disk_proxels, __global float* all_factors, int stride,
                                const __global float* radiosity, int band_count,
                                __global float* all_sums) {
    const Part own = own_part(salvo, closing_members(salvo));
    if (own.member < 0) return;
    const int block_count = stride / kReduceBlock;
    const int pe = own.share * get_local_size(0) + get_local_id(0);
    const int pe_count = get_global_size(0) / SALVO;
    __global int* proxel_count = proxel_counts + own.station * (stride + kCountsGap);
    __global float* factors = all_factors + own.station * kFactorKinds * stride;
    __global float* block_sums = all_sums + own.station * band_count * block_count;
    const Blocks blocks = own_blocks(pe, pe_count, block_count);
    for (int block = blocks.first; block < blocks.end; ++block) {
        real_v form_factor[BLOCK_VECTORS];
        const bool any = take_block(salvo + own.member, proxel_count, disk_proxels, factors, stride,
                                    block, form_factor);
        for (int band = 0; band < band_count; ++band)
            block_sums[band * block_count + block] =
                any ? sent_by_block(form_factor, radiosity + band * stride, block) : 0.0f;
    }
}
