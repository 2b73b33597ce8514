// Sec. 1.5.4: the most energetic patch of all, from those of the blocks; ties go to the lowest.
// Closes the books of the shot that was just made: shots, escaped flux, closure, convergence.
#include "shared.h"

#pragma OPENCL FP_CONTRACT OFF

// Compensated, see compensated.clh: at most once a shot.
static void add_escaped(__global float* sum, __global float* rest, float value) {
    const float increment = value + *rest;
    const float total = *sum + increment;
    const float part = total - *sum;
    *rest = (*sum - (total - part)) + (increment - part);
    *sum = total;
}

static void close_books(__global Shot* shot, const __global float* shot_flux, uint received_proxels,
                        __global int* escaped_count, float per_proxel, __global float* escaped) {
    const uint escapes = escaped_count[0];
    const uint proxels = received_proxels + escapes;
    for (int band = 0; band < BANDS; ++band)
        add_escaped(escaped + band, escaped + BANDS + band,
                    shot_flux[band] * (escapes * per_proxel));
    shot->least_proxels = min(shot->least_proxels, proxels);
    shot->most_proxels = max(shot->most_proxels, proxels);
    shot->escaped_proxels = escapes;
    ++shot->shots;
    escaped_count[0] = 0;  // of proxels that escaped, then of those outside the disk
    escaped_count[1] = 0;
}

__kernel void choose_shooter(__global Shot* shot, const __global BlockSummary* summaries,
                             const __global float* block_unshot, int block_count,
                             const __global float* unshot, int stride,
                             const __global float* band_weight, float tolerance, float per_proxel,
                             __global int* proxel_count, __global float* escaped,
                             __global float* shot_flux) {
    __local float energy[REDUCE_PES];
    __local int patch[REDUCE_PES];
    __local uint proxels[REDUCE_PES];
    __local float left[REDUCE_PES * BANDS];
    if (shot->status != kRunning) return;

    const int pe = get_local_id(0);
    float most = -1.0f;
    int most_patch = 0;
    uint proxel_sum = 0;
    for (int band = 0; band < BANDS; ++band) left[pe * BANDS + band] = 0.0f;
    for (int block = pe; block < block_count; block += REDUCE_PES) {
        const BlockSummary summary = summaries[block];
        if (summary.energy > most) {
            most = summary.energy;
            most_patch = summary.patch;
        }
        proxel_sum += summary.proxels;
        for (int band = 0; band < BANDS; ++band)
            left[pe * BANDS + band] += block_unshot[block * BANDS + band];
    }
    energy[pe] = most;
    patch[pe] = most_patch;
    proxels[pe] = proxel_sum;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (pe != 0) return;

    for (int other = 1; other < REDUCE_PES; ++other) {
        const bool first = energy[other] > energy[0] ||
                           (energy[other] == energy[0] && patch[other] < patch[0]);
        if (first) {
            energy[0] = energy[other];
            patch[0] = patch[other];
        }
        proxels[0] += proxels[other];
        for (int band = 0; band < BANDS; ++band) left[band] += left[other * BANDS + band];
    }
    if (shot->patch >= 0)
        close_books(shot, shot_flux, proxels[0], proxel_count + stride, per_proxel, escaped);

    // band_weight is 1 / emitted flux, 0 for a dark band.
    float unshot_fraction = 0.0f;
    for (int band = 0; band < BANDS; ++band)
        unshot_fraction = max(unshot_fraction, left[band] * band_weight[band]);
    shot->unshot_fraction = unshot_fraction;
    if (unshot_fraction < tolerance) shot->status = kConverged;
    if (!(energy[0] > 0.0f)) shot->status = kExhausted;
    shot->patch = patch[0];
    for (int band = 0; band < BANDS; ++band)
        shot_flux[band] = unshot[band * stride + patch[0]];
}
