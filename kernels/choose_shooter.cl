// Sec. 1.5.4: the most energetic shooter of all, from those of the blocks; ties go to the lowest. Of a
// salvo, the most energetic ones of so many blocks. Closes the books of the shots that were just made:
// shots, escaped flux, closure, convergence.
#include "progress.clh"
#include "row_pool.clh"
#include "shared.h"

#pragma OPENCL FP_CONTRACT OFF

// How many of the most energetic shooters are looked at: a salvo, and as many that may look ahead.
#define RANKS MEMBERS

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
static void close_counts(__global Shot* books, __global Shot* shot, __global int* spare_counts,
                         int disk_proxels) {
    const uint escapes = spare_counts[0], owned = spare_counts[2];
    const int shot_proxels = disk_proxels * shot->part_count;
    const int surplus = (int)(owned + escapes) - shot_proxels;
#ifndef FORM_FACTOR_ANALYTIC
    shot->escaped_fraction = (float)escapes / shot_proxels;
#endif
    books->least_surplus = min(books->least_surplus, surplus);
    books->most_surplus = max(books->most_surplus, surplus);
    shot->escaped_proxels = escapes;
    for (int kind = 0; kind < kSpareCounts; ++kind) spare_counts[kind] = 0;
}

// The first rows are kept: who has the most flux shoots first and most often.
// Of a salvo that found the memory full, none: which rows are whole depends on which PE came first.
static void keep_row(__global Shot* books, const __global Shot* shot, const __global RowPool* pool,
                     __global int* row_of, __global float* row_escaped) {
    row_escaped[shot->shooter] = shot->escaped_fraction;
    if (shot->row == 0 || is_full(pool)) return;
    row_of[shot->shooter] = shot->row;
    ++books->rows_kept;
}

static void close_salvo(__global Shot* salvo, __global int* proxel_counts, int stride,
                        int disk_proxels, const __global float* shot_flux,
                        const __global RowPool* pool, __global int* row_of,
                        __global float* row_escaped,
                        __global float* escaped, int counts_shots, __global uint* shots_of) {
    int station = 0;
    for (int member = 0; member < MEMBERS; ++member) {
        __global Shot* shot = salvo + member;
        if (shot->shooter < 0) break;
        if (!shot->row_known) {
            close_counts(salvo, shot,
                         proxel_counts + station++ * (stride + kCountsGap) + stride,
                         disk_proxels);
            keep_row(salvo, shot, pool, row_of, row_escaped);
        }
        if (shot->is_ahead) continue;
        for (int band = 0; band < BANDS; ++band)
            add_escaped(escaped + band, escaped + BANDS + band,
                        shot_flux[member * BANDS + band] * row_escaped[shot->shooter]);
        ++salvo->shots;
        if (counts_shots) ++shots_of[shot->shooter];
        salvo->repeated_shots += shot->row_known;
    }
    salvo->repeated_salvos += station == 0;
}

// Shooters in the order in which they shoot: by energy, then by number.
static bool shoots_before(BlockSummary a, BlockSummary b) {
    return a.energy > b.energy || (a.energy == b.energy && a.shooter < b.shooter);
}

// A known row makes the shot without further hemispheres; a new one begins where memory is left.
// Returns whether it is new.
static bool enlist(__global Shot* shot, int shooter, __global RowPool* pool, int stride,
                   const __global int* row_of) {
    const uint units = directory_units(stride);
    shot->shooter = shooter;
    shot->row = row_of[shooter];
    shot->row_known = shot->row != 0;
    shot->part = shot->row_known;
    shot->part_count = 1;
    shot->is_done = shot->is_ahead = 0;
    if (!shot->row_known && has_room(pool, units)) {
        shot->row = pool->taken;
        pool->taken += units;
    }
    return !shot->row_known;
}

// Behind the last of a salvo: a shot by a known row, at nothing.
static void leave_out(__global Shot* shot) {
    shot->shooter = -1;
    shot->row = 0;
    shot->row_known = 1;
    shot->part = shot->part_count = 1;
}

// Who shoots: the most energetic ones, so far as each has kLeastShare of the first one's energy; crumbs
// are better left to grow. Where one of them has to look, those that are to shoot soon look ahead, if
// they have no row yet and it can be kept, as far as there are stations.
#define kLeastShare 0.5f
#define kLeastShareAhead 0.25f
static void aim_salvo(__global Shot* salvo, const BlockSummary* best,
                      const __global float* unshot, int shooter_stride, __global RowPool* pool,
                      int stride, const __global int* row_of, __global float* shot_flux) {
    int looking = 0, size = 0;
    for (; size < SALVO; ++size) {
        const BlockSummary next = best[size];
        if (size > 0 && (next.energy < kLeastShare * best->energy ||
                         salvo->shots + size >= salvo->most_shots))
            break;
        for (int band = 0; band < BANDS; ++band)
            shot_flux[size * BANDS + band] = unshot[band * shooter_stride + next.shooter];
        looking += enlist(salvo + size, next.shooter, pool, stride, row_of);
    }
    const int stations = looking > 0 ? SALVO : 0;
    for (int rank = size; rank < RANKS && looking < stations; ++rank) {
        const BlockSummary next = best[rank];
        if (next.energy < kLeastShareAhead * best->energy) break;
        if (row_of[next.shooter] != 0) continue;
        if (!has_room(pool, directory_units(stride))) break;
        looking += enlist(salvo + size, next.shooter, pool, stride, row_of);
        salvo[size++].is_ahead = 1;
    }
    for (; size < MEMBERS; ++size) leave_out(salvo + size);
}

// Fluxes are parts of what a band emits; band_weight is 0 for a dark band, else 1.
static float unshot_fraction_of(const __local float* left, const __global float* band_weight) {
    float unshot_fraction = 0.0f;
    for (int band = 0; band < BANDS; ++band)
        unshot_fraction = max(unshot_fraction, left[band] * band_weight[band]);
    return unshot_fraction;
}

static int next_status(const __global Shot* books, float energy, float tolerance) {
    // A part of the flux that is no normal float: reflections would round it up again, for ever.
    if (!(energy > FLT_MIN)) return kExhausted;
    if (books->unshot_fraction < tolerance) return kConverged;
    return books->shots >= books->shot_limit ? kPaused : kRunning;
}

// The blocks' shooters that one of REDUCE_PES PEs goes through, in the order in which they shoot.
static void rank_blocks(const __global BlockSummary* summaries, int block_count, int pe,
                        __local BlockSummary* best) {
    const BlockSummary none = {-1.0f, 0};
    for (int rank = 0; rank < RANKS; ++rank) best[rank] = none;
    for (int block = pe; block < block_count; block += REDUCE_PES) {
        BlockSummary next = summaries[block];
        if (!shoots_before(next, best[RANKS - 1])) continue;
        for (int rank = 0; rank < RANKS; ++rank)
            if (shoots_before(next, best[rank])) {
                const BlockSummary later = best[rank];
                best[rank] = next;
                next = later;
            }
    }
}

// Of all PEs' the first RANKS, by merging.
static void merge_ranks(const __local BlockSummary* best, BlockSummary* merged) {
    int taken[REDUCE_PES];
    for (int pe = 0; pe < REDUCE_PES; ++pe) taken[pe] = 0;
    for (int rank = 0; rank < RANKS; ++rank) {
        int from = 0;
        for (int pe = 1; pe < REDUCE_PES; ++pe)
            if (shoots_before(best[pe * RANKS + taken[pe]], best[from * RANKS + taken[from]]))
                from = pe;
        merged[rank] = best[from * RANKS + taken[from]];
        taken[from] = min(taken[from] + 1, RANKS - 1);
    }
}

// shots_of: [shooter] the shots that it made, if anyone asks: counts_shots.
__kernel void choose_shooter(__global Shot* salvo, const __global BlockSummary* summaries,
                             const __global float* block_unshot, int block_count,
                             const __global float* unshot, int shooter_stride,
                             const __global float* band_weight, float tolerance, int disk_proxels,
                             __global int* proxel_counts, int stride, __global float* escaped,
                             __global float* shot_flux, __global RowPool* pool,
                             __global int* row_of, __global float* row_escaped, int counts_shots,
                             __global uint* shots_of) {
    __local BlockSummary best[REDUCE_PES * RANKS];
    __local float left[REDUCE_PES * BANDS];
    const int pe = get_local_id(0);
    for (int band = 0; band < BANDS; ++band) {
        float sum = 0.0f;
        for (int block = pe; block < block_count; block += REDUCE_PES)
            sum += block_unshot[block * BANDS + band];
        left[pe * BANDS + band] = sum;
    }
    rank_blocks(summaries, block_count, pe, best + pe * RANKS);
    barrier(CLK_LOCAL_MEM_FENCE);

    // No work-item may leave before a barrier, see prefix_sum.cl.
    if (pe == 0 && is_shooting(salvo)) {
        close_salvo(salvo, proxel_counts, stride, disk_proxels, shot_flux, pool, row_of,
                    row_escaped, escaped, counts_shots, shots_of);
        for (int other = 1; other < REDUCE_PES; ++other)
            for (int band = 0; band < BANDS; ++band) left[band] += left[other * BANDS + band];
        salvo->unshot_fraction = unshot_fraction_of(left, band_weight);
        BlockSummary ranked[RANKS];
        merge_ranks(best, ranked);
        const int status = next_status(salvo, ranked[0].energy, tolerance);
        aim_salvo(salvo, ranked, unshot, shooter_stride, pool, stride, row_of, shot_flux);
        for (int member = 0; member < MEMBERS; ++member) salvo[member].status = status;
    }
}
