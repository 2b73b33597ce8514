// Sec. 1.5.4 in one launch where every patch is its own shooter: a block's patches receive, and what
// they reflect is added up while their form factors are at hand, in a place of the PE's.
// Compiled behind update_radiosity and update_unshot, whose functions it calls.
// block_factors: [PE][shooter, and one more][patch of a block].

__kernel void receive_flux(const __global Shot* salvo, const __global float* shot_flux,
                           __global int* proxel_counts, int disk_proxels, __global float* factors,
                           int stride, __global uint* row_words, __global RowPool* pool,
                           __global Extent* extents, __global float* block_factors,
                           __global float* received, __global float* received_rest,
                           __global float* unshot, const __global float* reflectance,
                           const __global float* band_weight, __global BlockSummary* summaries,
                           __global float* block_unshot) {
    const Place own = own_place();
    if (own.pe < 0 || !is_shooting(salvo)) return;
    const int size = salvo_size(salvo), shooters = shooter_count(salvo);
    const Sources from = {proxel_counts, factors, disk_proxels, stride};
    const Rows rows = {row_words, pool, extents + own.pe};
    __global float* form_factors = block_factors + own.pe * (SALVO + 1) * kReduceBlock;
    int owned[SALVO] = {0};
    const Blocks blocks = own_blocks(own.pe, own.count, stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block) {
        salvo_form_factors(salvo, shooters, size, &from, &rows, block, form_factors, kReduceBlock,
                           owned);
        Reduction reduction;
        begin_reduction(salvo, shooters, block, &reduction);
        for (int step = 0; step < BLOCK_VECTORS; ++step) {
            const int patch = block * kReduceBlock + step * LANES;
            real_v form_factor[SALVO];
            load_form_factors(form_factors + step * LANES, kReduceBlock, shooters, form_factor);
            receive(form_factor, shooters, shot_flux, stride, patch, received, received_rest);
            reduce(salvo, shooters, form_factor, shot_flux, patch, step, stride, unshot,
                   reflectance, band_weight, &reduction);
        }
        end_reduction(&reduction, block, summaries, block_unshot);
    }
    add_owned(owned, stride, proxel_counts);
}
