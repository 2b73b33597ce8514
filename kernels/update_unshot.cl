// Sec. 1.5.4: what the shots' flux leaves to be shot. A shooter has none left but what it and those
// that shoot at once sent to it. Each PE then reduces the unshot flux of its blocks, the first level
// of the choice of the most energetic shooter. With TWO_LEVELS (Cohen et al.) a shooter is a group of
// patches, their elements, and reflects what all of these received.
// shot_rows: [shooter][patch], of this shot. unshot, reflectance: [band][shooter]; flux in normalised units.
// first_patch: [shooter], and one more. block_unshot: [block][band].
#include "salvo.clh"

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

// The shooters of a salvo among LANES patches, which have shot what they had.
static int_v are_shooters(const __global Shot* salvo, int size, int shooter) {
    int_v result = (int_v)0;
    for (int member = 0; member < size; ++member)
        result |= equal_v((int_v)shooter + LANE_INDEX, (int_v)salvo[member].shooter);
    return result;
}

static bool has_shooter(const __global Shot* salvo, int size, int block) {
    bool result = false;
    for (int member = 0; member < size; ++member)
        result |= salvo[member].shooter / kReduceBlock == block;
    return result;
}

// What a block's shooters have left, in the making.
typedef struct {
    BlockSummary summary;
    bool has_shot;
    real_v sums[BANDS][ACCUMULATORS];
} Reduction;

static void begin_reduction(const __global Shot* salvo, int size, int block, Reduction* reduction) {
    const BlockSummary none = {-1.0f, 0};
    reduction->summary = none;
    reduction->has_shot = has_shooter(salvo, size, block);
    for (int band = 0; band < BANDS; ++band)
        for (int a = 0; a < ACCUMULATORS; ++a) reduction->sums[band][a] = (real_v)0.0f;
}

// What is left to LANES shooters, by the form factors to them.
static void reduce(const __global Shot* salvo, int size, const real_v* form_factor,
                   const __global float* shot_flux, int shooter, int step, int shooter_stride,
                   __global float* unshot, const __global float* reflectance,
                   const __global float* band_weight, Reduction* reduction) {
    const int_v shot = reduction->has_shot ? are_shooters(salvo, size, shooter) : (int_v)0;
    real_v energy = (real_v)0.0f;
    for (int band = 0; band < BANDS; ++band) {
        const int at = band * shooter_stride + shooter;
        const real_v kept = choose_v(shot, (real_v)0.0f, load_v(at, unshot));
        const real_v left = fma(load_v(at, reflectance),
                                flux_to(form_factor, size, shot_flux, band), kept);
        *real_vectors(unshot + at) = left;
        energy = fma((real_v)band_weight[band], left, energy);
        reduction->sums[band][step % ACCUMULATORS] += left;
    }
    if (!any_v(less_v((real_v)reduction->summary.energy, energy))) return;
    for (int lane = 0; lane < LANES; ++lane)
        if (lane_of(energy, lane) > reduction->summary.energy) {
            reduction->summary.energy = lane_of(energy, lane);
            reduction->summary.shooter = shooter + lane;
        }
}

static void end_reduction(const Reduction* reduction, int block, __global BlockSummary* summaries,
                          __global float* block_unshot) {
    summaries[block] = reduction->summary;
    for (int band = 0; band < BANDS; ++band)
        block_unshot[block * BANDS + band] = total_of(reduction->sums[band]);
}

__kernel void update_unshot(const __global Shot* salvo, const __global float* shot_flux,
                            const __global float* shot_rows, int stride,
                            const __global int* first_patch, int shooter_stride,
                            __global float* unshot,
                            const __global float* reflectance, const __global float* band_weight,
                            __global BlockSummary* summaries, __global float* block_unshot) {
    const Place own = own_place();
    if (own.pe < 0 || !is_shooting(salvo)) return;
    const int size = shooter_count(salvo);
    const Blocks blocks = own_blocks(own.pe, own.count, shooter_stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block) {
        Reduction reduction;
        begin_reduction(salvo, size, block, &reduction);
        for (int step = 0; step < BLOCK_VECTORS; ++step) {
            const int shooter = block * kReduceBlock + step * LANES;
            real_v form_factor[SALVO];
            for (int member = 0; member < size; ++member)
                form_factor[member] = form_factor_to(shot_rows + (size_t)member * stride,
                                                     first_patch, shooter);
            reduce(salvo, size, form_factor, shot_flux, shooter, step, shooter_stride, unshot,
                   reflectance, band_weight, &reduction);
        }
        end_reduction(&reduction, block, summaries, block_unshot);
    }
}
