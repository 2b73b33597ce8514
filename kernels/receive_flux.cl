// Sec. 1.5.4 in one launch where every patch is its own shooter: a block's patches receive, and what
// they reflect is added up while their form factors are at hand. A row that is not kept, beyond
// row_capacity, is not written at all.
// Compiled behind update_radiosity and update_unshot, whose functions it calls.

__kernel void receive_flux(const __global Shot* salvo, const __global float* shot_flux,
                           __global int* proxel_counts, int disk_proxels, __global float* factors,
                           int stride, __global float* rows, int row_capacity,
                           __global float* received, __global float* received_rest,
                           __global float* unshot, const __global float* reflectance,
                           const __global float* band_weight, __global BlockSummary* summaries,
                           __global float* block_unshot) {
    if (!is_shooting(salvo)) return;
    const int size = salvo_size(salvo), shooters = shooter_count(salvo);
    int owned[SALVO] = {0};
    const Blocks blocks = own_blocks(get_global_id(0), get_global_size(0), stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block) {
        Reduction reduction;
        begin_reduction(salvo, shooters, block, &reduction);
        for (int step = 0; step < BLOCK_VECTORS; ++step) {
            const int patch = block * kReduceBlock + step * LANES;
            real_v form_factor[SALVO];
            salvo_form_factors(salvo, shooters, size, proxel_counts, disk_proxels, factors, stride,
                               rows, row_capacity, patch, form_factor, owned);
            receive(form_factor, shooters, shot_flux, stride, patch, received, received_rest);
            reduce(salvo, shooters, form_factor, shot_flux, patch, step, stride, unshot,
                   reflectance, band_weight, &reduction);
        }
        end_reduction(&reduction, block, summaries, block_unshot);
    }
    add_owned(owned, stride, proxel_counts);
}
