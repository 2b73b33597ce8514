// Sec. 1.5.4 in one launch where every patch is its own shooter: a block's patches receive, and what
// they reflect is added up while their form factors are at hand. A row that is not kept, row_capacity,
// is not written at all.
// Compiled behind update_radiosity and update_unshot, whose functions it calls.

__kernel void receive_flux(const __global Shot* shot, const __global float* shot_flux,
                           __global int* proxel_count, int disk_proxels, __global float* factors,
                           int stride, __global float* rows, int row_capacity,
                           __global float* received, __global float* received_rest,
                           __global float* unshot, const __global float* reflectance,
                           const __global float* band_weight, __global BlockSummary* summaries,
                           __global float* block_unshot) {
    if (!is_shooting(shot)) return;
    const float proxels_shot = disk_proxels * max(shot->part_count, 1u);
    __global float* row = rows + (size_t)shot->row * stride;
    const bool keeps_row = !shot->row_known && shot->row != row_capacity;
    int owned = 0;
    for (int block = get_global_id(0); block < stride / kReduceBlock;
         block += get_global_size(0)) {
        real_v form_factor[BLOCK_VECTORS];
        owned += form_factors_to(shot, proxel_count, proxels_shot, factors, stride, row, block,
                                 form_factor);
        if (keeps_row) keep_block(form_factor, block, row);
        receive_block(form_factor, shot_flux, stride, block, received, received_rest);
        reduce_block(shot, form_factor, shot_flux, block, stride, unshot, reflectance, band_weight,
                     summaries, block_unshot);
    }
    if (owned != 0) atomic_add(proxel_count + stride + 2, owned);
}
