// Sec. 1.5.4: the most energetic shooter of all, from those of the blocks; ties go to the lowest.
// Closes the books of the shot that was just made: shots, escaped flux, closure, convergence.
#include "progress.clh"
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

// Counts beyond the patches': of proxels that escaped, of those outside the disk, and of those that
// patches own but are not, or no more, counted for them: see update_radiosity.cl,
// estimate_form_factors.cl and coverage.clh.
static void close_counts(__global Shot* shot, __global int* spare_counts, int disk_proxels) {
    const uint escapes = spare_counts[0], owned = spare_counts[2];
    const int shot_proxels = disk_proxels * shot->part_count;
    const int surplus = (int)(owned + escapes) - shot_proxels;
#ifndef FORM_FACTOR_ANALYTIC
    shot->escaped_fraction = (float)escapes / shot_proxels;
#endif
    shot->least_surplus = min(shot->least_surplus, surplus);
    shot->most_surplus = max(shot->most_surplus, surplus);
    shot->escaped_proxels = escapes;
    for (int kind = 0; kind < kSpareCounts; ++kind) spare_counts[kind] = 0;
}

// The first rows are kept: who has the most flux shoots first and most often.
static void keep_row(__global Shot* shot, int row_capacity, __global int* row_of,
                     __global float* row_escaped) {
    row_escaped[shot->row] = shot->escaped_fraction;
    if (shot->row == row_capacity) return;
    row_of[shot->shooter] = shot->row + 1;
    ++shot->rows_kept;
}

static void close_books(__global Shot* shot, const __global float* shot_flux,
                        const __global float* row_escaped, __global float* escaped) {
    for (int band = 0; band < BANDS; ++band)
        add_escaped(escaped + band, escaped + BANDS + band,
                    shot_flux[band] * row_escaped[shot->row]);
    ++shot->shots;
    shot->repeated_shots += shot->row_known;
}

// The more energetic of two, the lower of equals. Adds the rest up.
static void merge(__local BlockSummary* into, __local float* left, BlockSummary other,
                  const __local float* other_left) {
    if (other.energy > into->energy ||
        (other.energy == into->energy && other.shooter < into->shooter)) {
        into->energy = other.energy;
        into->shooter = other.shooter;
    }
    for (int band = 0; band < BANDS; ++band) left[band] += other_left[band];
}

// Fluxes are parts of what a band emits; band_weight is 0 for a dark band, else 1.
static void aim_at(__global Shot* shot, BlockSummary best, const __local float* left,
                   const __global float* unshot, int shooter_stride,
                   const __global float* band_weight, float tolerance, __global float* shot_flux) {
    float unshot_fraction = 0.0f;
    for (int band = 0; band < BANDS; ++band) {
        unshot_fraction = max(unshot_fraction, left[band] * band_weight[band]);
        shot_flux[band] = unshot[band * shooter_stride + best.shooter];
    }
    shot->unshot_fraction = unshot_fraction;
    shot->shooter = best.shooter;
    if (shot->shots >= shot->shot_limit) shot->status = kPaused;
    if (unshot_fraction < tolerance) shot->status = kConverged;
    // A part of the flux that is no normal float: reflections would round it up again, for ever.
    if (!(best.energy > FLT_MIN)) shot->status = kExhausted;
}

// A known row makes the shot without further hemispheres; a row that is not kept goes behind those
// that are.
static void find_row(__global Shot* shot, const __global int* row_of, int row_capacity) {
    const int known = row_of[shot->shooter];
    shot->row_known = known > 0;
    shot->row = known > 0 ? known - 1 : min((int)shot->rows_kept, row_capacity);
    shot->part = shot->row_known;
    shot->part_count = 1;
}

__kernel void choose_shooter(__global Shot* shot, const __global BlockSummary* summaries,
                             const __global float* block_unshot, int block_count,
                             const __global float* unshot, int shooter_stride,
                             const __global float* band_weight, float tolerance, int disk_proxels,
                             __global int* proxel_count, int stride, __global float* escaped,
                             __global float* shot_flux, int row_capacity, __global int* row_of,
                             __global float* row_escaped) {
    __local BlockSummary summary[REDUCE_PES];
    __local float left[REDUCE_PES * BANDS];
    const int pe = get_local_id(0);
    BlockSummary mine = {-1.0f, 0};
    for (int band = 0; band < BANDS; ++band) left[pe * BANDS + band] = 0.0f;
    for (int block = pe; block < block_count; block += REDUCE_PES) {
        const BlockSummary next = summaries[block];
        if (next.energy > mine.energy) mine = next;
        for (int band = 0; band < BANDS; ++band)
            left[pe * BANDS + band] += block_unshot[block * BANDS + band];
    }
    summary[pe] = mine;
    barrier(CLK_LOCAL_MEM_FENCE);

    // No work-item may leave before a barrier, see prefix_sum.cl.
    if (pe == 0 && is_shooting(shot)) {
        for (int other = 1; other < REDUCE_PES; ++other)
            merge(summary, left, summary[other], left + other * BANDS);
        if (shot->shooter >= 0) {
            if (!shot->row_known) {
                close_counts(shot, proxel_count + stride, disk_proxels);
                keep_row(shot, row_capacity, row_of, row_escaped);
            }
            close_books(shot, shot_flux, row_escaped, escaped);
        }
        aim_at(shot, summary[0], left, unshot, shooter_stride, band_weight, tolerance, shot_flux);
        find_row(shot, row_of, row_capacity);
    }
}
