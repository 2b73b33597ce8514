// Sec. 1.5.4 in one launch where every patch is its own shooter: a PE's patches receive, and then
// their unshot flux is its own to reduce.
// Compiled behind the two kernels that it calls.

__kernel void receive_flux(const __global Shot* shot, const __global float* shot_flux,
                           __global int* proxel_count, int disk_proxels, __global float* factors,
                           int stride, __global float* rows, __global float* received,
                           __global float* received_rest, const __global int* first_patch,
                           int shooter_stride, __global float* unshot,
                           const __global float* reflectance, const __global float* band_weight,
                           __global BlockSummary* summaries, __global float* block_unshot) {
    update_radiosity(shot, shot_flux, proxel_count, disk_proxels, factors, stride, rows, received,
                     received_rest);
    update_unshot(shot, shot_flux, rows, stride, first_patch, shooter_stride, unshot, reflectance,
                  band_weight, summaries, block_unshot);
}
