// Sec. 1.5.4: every patch adds the flux that its form factor brings it, by the reciprocity of
// eq. 1.1: F_ji B_i A_j = F_ij A_i B_i, so fluxes need no areas. A shooter's row of form factors is
// what its hemispheres counted, or what an earlier shot of it left in `rows`. Nothing is done before
// the last hemisphere of all that shoot at once.
// rows: [row][patch]. received, received_rest: [band][patch]; shot_flux: [shooter][band]; flux in
// normalised units.
#include "compensated.clh"
#include "salvo.clh"

#ifdef FORM_FACTOR_ANALYTIC

// Of LANES patches, closed (spread_residual.cl); the sums are spent. Those of patches that are not
// before the shooter are 0 already.
static real_v take_form_factors(const __global Shot* shot, __global float* factors, int stride,
                                int patch) {
    const real_v unblocked = load_v(kUnblockedFactor * stride + patch, factors);
    if (!any_v(less_v((real_v)0.0f, unblocked))) return (real_v)0.0f;
    const real_v visible = load_v(kVisibleFactor * stride + patch, factors);
    const real_v doubtful = load_v(kDoubtfulFactor * stride + patch, factors);
    for (int kind = 0; kind < kFactorKinds; ++kind)
        *real_vectors(factors + kind * stride + patch) = (real_v)0.0f;
    return fma(doubtful, (real_v)shot->residual_share, visible * shot->factor_scale);
}

#else

// Proxels of LANES patches over those of the disks; the counts are spent.
static real_v take_counts(__global int* proxel_count, float proxels_shot, int patch, int* owned) {
    const int_v counts = load_v(patch, proxel_count);
    if (any_v(counts != 0)) {
        *int_vectors(proxel_count + patch) = (int_v)0;
        for (int lane = 0; lane < LANES; ++lane) *owned += int_lane_of(counts, lane);
    }
    return to_real_v(counts) / proxels_shot;
}

#endif

// A shooter's form factors to a block of patches; those that were not known are spent. Returns the
// proxels that the block owns.
static int form_factors_to(const __global Shot* shot, __global int* proxel_count, int disk_proxels,
                           __global float* factors, int stride, const __global float* row,
                           int block, real_v* form_factor) {
    const float proxels_shot = disk_proxels * max(shot->part_count, 1u);
    int owned = 0;
    for (int step = 0; step < BLOCK_VECTORS; ++step) {
        const int patch = block * kReduceBlock + step * LANES;
        if (shot->row_known)
            form_factor[step] = load_v(patch, row);
        else
#ifdef FORM_FACTOR_ANALYTIC
            form_factor[step] = take_form_factors(shot, factors, stride, patch);
#else
            form_factor[step] = take_counts(proxel_count, proxels_shot, patch, &owned);
#endif
    }
    return owned;
}

static void keep_block(const real_v* form_factor, int block, __global float* row) {
    for (int step = 0; step < BLOCK_VECTORS; ++step)
        *real_vectors(row + block * kReduceBlock + step * LANES) = form_factor[step];
}

// Of the first `shooters` members to a block of patches: [shooter][step]. New rows below row_end are
// kept, of those that look ahead as well. Proxels that the block owns are added to each member's.
static void salvo_form_factors(const __global Shot* salvo, int shooters, int size,
                               __global int* proxel_counts, int disk_proxels,
                               __global float* factors, int stride, __global float* rows,
                               int row_end, int block, real_v* form_factor) {
    int station = 0;
    for (int member = 0; member < size; ++member) {
        const __global Shot* shot = salvo + member;
        __global int* proxel_count = proxel_counts + station * (stride + kCountsGap);
        __global float* row = rows + (size_t)shot->row * stride;
        real_v* own = form_factor + min(member, shooters) * BLOCK_VECTORS;
        const int owned =
            form_factors_to(shot, proxel_count, disk_proxels,
                            factors + station * kFactorKinds * stride, stride, row, block, own);
        if (owned != 0) atomic_add(proxel_count + stride + 2, owned);
        if (shot->row_known) continue;
        if (shot->row < row_end) keep_block(own, block, row);
        ++station;
    }
}

static void receive_block(const real_v* form_factor, int size, const __global float* shot_flux,
                          int stride, int block, __global float* received,
                          __global float* received_rest) {
    for (int step = 0; step < BLOCK_VECTORS; ++step)
        for (int band = 0; band < BANDS; ++band) {
            const int at = band * stride + block * kReduceBlock + step * LANES;
            real_v sum = load_v(at, received), rest = load_v(at, received_rest);
            add_compensated(&sum, &rest, flux_to(form_factor, size, shot_flux, step, band));
            *real_vectors(received + at) = sum;
            *real_vectors(received_rest + at) = rest;
        }
}

__kernel void update_radiosity(const __global Shot* salvo, const __global float* shot_flux,
                               __global int* proxel_counts, int disk_proxels,
                               __global float* factors, int stride, __global float* rows,
                               __global float* received, __global float* received_rest) {
    if (!is_shooting(salvo)) return;
    const int size = salvo_size(salvo), shooters = shooter_count(salvo);
    for (int block = get_global_id(0); block < stride / kReduceBlock;
         block += get_global_size(0)) {
        real_v form_factor[(SALVO + 1) * BLOCK_VECTORS];
        salvo_form_factors(salvo, shooters, size, proxel_counts, disk_proxels, factors, stride, rows,
                           INT_MAX, block, form_factor);
        receive_block(form_factor, shooters, shot_flux, stride, block, received, received_rest);
    }
}
