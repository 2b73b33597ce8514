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
                        __global int* escaped_count, int disk_proxels, __global float* escaped) {
    const uint escapes = escaped_count[0];
    const int shot_proxels = disk_proxels * shot->part_count;
    const int surplus = (int)(received_proxels + escapes) - shot_proxels;
#ifndef FORM_FACTOR_ANALYTIC
    shot->escaped_fraction = (float)escapes / shot_proxels;
#endif
    for (int band = 0; band < BANDS; ++band)
        add_escaped(escaped + band, escaped + BANDS + band,
                    shot_flux[band] * shot->escaped_fraction);
    shot->least_surplus = min(shot->least_surplus, surplus);
    shot->most_surplus = max(shot->most_surplus, surplus);
    shot->escaped_proxels = escapes;
    ++shot->shots;
    // Of proxels that escaped, of those outside the disk, and of those that patches own but are not
    // counted for them: see estimate_form_factors.cl and coverage.clh.
    for (int kind = 0; kind < kSpareCounts; ++kind) escaped_count[kind] = 0;
}

// The more energetic of two, the lower patch of equals. Adds the rest up.
static void merge(__local BlockSummary* into, __local float* left, BlockSummary other,
                  const __local float* other_left) {
    if (other.energy > into->energy ||
        (other.energy == into->energy && other.patch < into->patch)) {
        into->energy = other.energy;
        into->patch = other.patch;
    }
    into->proxels += other.proxels;
    for (int band = 0; band < BANDS; ++band) left[band] += other_left[band];
}

// Fluxes are parts of what a band emits; band_weight is 0 for a dark band, else 1.
static void aim_at(__global Shot* shot, BlockSummary best, const __local float* left,
                   const __global float* unshot, int stride, const __global float* band_weight,
                   float tolerance, __global float* shot_flux) {
    float unshot_fraction = 0.0f;
    for (int band = 0; band < BANDS; ++band) {
        unshot_fraction = max(unshot_fraction, left[band] * band_weight[band]);
        shot_flux[band] = unshot[band * stride + best.patch];
    }
    shot->unshot_fraction = unshot_fraction;
    shot->patch = best.patch;
    shot->part = 0;
    if (shot->shots >= shot->shot_limit) shot->status = kPaused;
    if (unshot_fraction < tolerance) shot->status = kConverged;
    // A part of the flux that is no normal float: reflections would round it up again, for ever.
    if (!(best.energy > FLT_MIN)) shot->status = kExhausted;
}

__kernel void choose_shooter(__global Shot* shot, const __global BlockSummary* summaries,
                             const __global float* block_unshot, int block_count,
                             const __global float* unshot, int stride,
                             const __global float* band_weight, float tolerance, int disk_proxels,
                             __global int* proxel_count, __global float* escaped,
                             __global float* shot_flux) {
    __local BlockSummary summary[REDUCE_PES];
    __local float left[REDUCE_PES * BANDS];
    const int pe = get_local_id(0);
    BlockSummary mine = {-1.0f, 0, 0u};
    for (int band = 0; band < BANDS; ++band) left[pe * BANDS + band] = 0.0f;
    for (int block = pe; block < block_count; block += REDUCE_PES) {
        const BlockSummary next = summaries[block];
        const uint proxels = mine.proxels + next.proxels;
        if (next.energy > mine.energy) mine = next;
        mine.proxels = proxels;
        for (int band = 0; band < BANDS; ++band)
            left[pe * BANDS + band] += block_unshot[block * BANDS + band];
    }
    summary[pe] = mine;
    barrier(CLK_LOCAL_MEM_FENCE);

    // No work-item may leave before a barrier, see prefix_sum.cl.
    if (pe == 0 && shot->status == kRunning && shot->part >= shot->part_count) {
        for (int other = 1; other < REDUCE_PES; ++other)
            merge(summary, left, summary[other], left + other * BANDS);
        if (shot->patch >= 0)
            close_books(shot, shot_flux, summary[0].proxels + proxel_count[stride + 2],
                        proxel_count + stride, disk_proxels,
                        escaped);
        aim_at(shot, summary[0], left, unshot, stride, band_weight, tolerance, shot_flux);
    }
}
