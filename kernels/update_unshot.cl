// Sec. 1.5.4: what the shot's flux leaves to be shot. The shooter has none left but what it sent to
// itself. Each PE then reduces the unshot flux of its blocks, the first level of the choice of the
// most energetic shooter. With TWO_LEVELS (Cohen et al.) a shooter is a group of patches, their
// elements, and reflects what all of these received.
// rows: [row][patch]. unshot, reflectance: [band][shooter]; flux in normalised units.
// first_patch: [shooter], and one more. block_unshot: [block][band].
#include "lanes.clh"
#include "progress.clh"
#include "shared.h"
#include "sixteen_sums.clh"

#ifdef TWO_LEVELS

static float sum_of(const __global float* row, int begin, int end) {
    float sums[16];
    for (int k = 0; k < 16; ++k) sums[k] = 0.0f;
    for (int patch = begin; patch < end; ++patch) sums[(patch - begin) % 16] += row[patch];
    float total = 0.0f;
    for (int k = 0; k < 16; ++k) total += sums[k];
    return total;
}

// Of LANES shooters; those beyond the last have no patches.
static real_v form_factor_to(const __global float* row, const __global int* first_patch,
                             int shooter) {
    real_v result;
    for (int lane = 0; lane < LANES; ++lane)
        ((float*)&result)[lane] =
            sum_of(row, first_patch[shooter + lane], first_patch[shooter + lane + 1]);
    return result;
}

#else

static real_v form_factor_to(const __global float* row, const __global int* first_patch,
                             int shooter) {
    return load_v(shooter, row);
}

#endif

// What is left to the shooters of a block, by the form factors to them.
static void reduce_block(const __global Shot* shot, const real_v* form_factor,
                         const __global float* shot_flux, int block, int shooter_stride,
                         __global float* unshot, const __global float* reflectance,
                         const __global float* band_weight, __global BlockSummary* summaries,
                         __global float* block_unshot) {
    BlockSummary summary = {-1.0f, 0};
    real_v sums[BANDS][ACCUMULATORS];
    for (int band = 0; band < BANDS; ++band)
        for (int a = 0; a < ACCUMULATORS; ++a) sums[band][a] = (real_v)0.0f;
    for (int step = 0; step < BLOCK_VECTORS; ++step) {
        const int shooter = block * kReduceBlock + step * LANES;
        const int_v is_shooter = (shooter + LANE_INDEX) == shot->shooter ? (int_v)-1 : (int_v)0;
        real_v energy = (real_v)0.0f;
        for (int band = 0; band < BANDS; ++band) {
            const int at = band * shooter_stride + shooter;
            const real_v kept = choose_v(is_shooter, (real_v)0.0f, load_v(at, unshot));
            const real_v left =
                fma(load_v(at, reflectance), form_factor[step] * shot_flux[band], kept);
            *real_vectors(unshot + at) = left;
            energy = fma((real_v)band_weight[band], left, energy);
            sums[band][step % ACCUMULATORS] += left;
        }
        if (!any_v(less_v((real_v)summary.energy, energy))) continue;
        for (int lane = 0; lane < LANES; ++lane)
            if (lane_of(energy, lane) > summary.energy) {
                summary.energy = lane_of(energy, lane);
                summary.shooter = shooter + lane;
            }
    }
    summaries[block] = summary;
    for (int band = 0; band < BANDS; ++band)
        block_unshot[block * BANDS + band] = total_of(sums[band]);
}

__kernel void update_unshot(const __global Shot* shot, const __global float* shot_flux,
                            const __global float* rows, int stride, const __global int* first_patch,
                            int shooter_stride, __global float* unshot,
                            const __global float* reflectance, const __global float* band_weight,
                            __global BlockSummary* summaries, __global float* block_unshot) {
    if (!is_shooting(shot)) return;
    const __global float* row = rows + (size_t)shot->row * stride;
    for (int block = get_global_id(0); block < shooter_stride / kReduceBlock;
         block += get_global_size(0)) {
        real_v form_factor[BLOCK_VECTORS];
        for (int step = 0; step < BLOCK_VECTORS; ++step)
            form_factor[step] =
                form_factor_to(row, first_patch, block * kReduceBlock + step * LANES);
        reduce_block(shot, form_factor, shot_flux, block, shooter_stride, unshot, reflectance,
                     band_weight, summaries, block_unshot);
    }
}
