// Sec. 1.5.4: every patch adds the flux that its form factor brings it, by the reciprocity of
// eq. 1.1: F_ji B_i A_j = F_ij A_i B_i, so fluxes need no areas. Each PE then reduces the unshot
// flux of its blocks, the first level of the choice of the most energetic patch. Nothing is done
// before the shooter's last hemisphere.
// received, received_rest, unshot, reflectance: [band][patch]; flux in normalised units.
#include "compensated.clh"
#include "shared.h"
#include "sixteen_sums.clh"

static void shoot_at(const __global Shot* shot, const __global float* shot_flux, int stride,
                     int patch, real_v form_factor, __global float* received,
                     __global float* received_rest, __global float* unshot,
                     const __global float* reflectance) {
    const int_v is_shooter = (patch + LANE_INDEX) == shot->patch ? (int_v)-1 : (int_v)0;
    for (int band = 0; band < BANDS; ++band) {
        const int at = band * stride + patch;
        const real_v flux = form_factor * shot_flux[band];
        real_v sum = load_v(at, received), rest = load_v(at, received_rest);
        add_compensated(&sum, &rest, flux);
        *real_vectors(received + at) = sum;
        *real_vectors(received_rest + at) = rest;
        const real_v left = choose_v(is_shooter, (real_v)0.0f, load_v(at, unshot));
        *real_vectors(unshot + at) = fma(load_v(at, reflectance), flux, left);
    }
}

#ifdef FORM_FACTOR_ANALYTIC

// Of LANES patches, closed (spread_residual.cl); the sums are spent.
static real_v take_form_factors(const __global Shot* shot, __global float* factors, int stride,
                                int patch) {
    const real_v visible = load_v(kVisibleFactor * stride + patch, factors);
    const real_v doubtful = load_v(kDoubtfulFactor * stride + patch, factors);
    for (int kind = 0; kind < kFactorKinds; ++kind)
        *real_vectors(factors + kind * stride + patch) = (real_v)0.0f;
    return fma(doubtful, (real_v)shot->residual_share, visible * shot->factor_scale);
}

#else

// Proxels of LANES patches over those of the disks; the counts are spent.
static real_v take_counts(__global int* proxel_count, float proxels_shot, int patch,
                          uint* proxels) {
    const int_v counts = load_v(patch, proxel_count);
    if (any_v(counts != 0)) {
        *int_vectors(proxel_count + patch) = (int_v)0;
        for (int lane = 0; lane < LANES; ++lane) *proxels += int_lane_of(counts, lane);
    }
    return to_real_v(counts) / proxels_shot;
}

#endif

__kernel void update_radiosity(__global Shot* shot, const __global float* shot_flux,
                               __global int* proxel_count, int disk_proxels,
                               __global float* factors, int stride,
                               __global float* received, __global float* received_rest,
                               __global float* unshot, const __global float* reflectance,
                               const __global float* band_weight,
                               __global BlockSummary* summaries, __global float* block_unshot) {
    if (shot->status != kRunning || shot->part < shot->part_count) return;
    const int pe = get_global_id(0), pe_count = get_global_size(0);
    const float proxels_shot = disk_proxels * max(shot->part_count, 1u);
    for (int block = pe; block < stride / kReduceBlock; block += pe_count) {
        BlockSummary summary = {-1.0f, 0, 0u};
        real_v sums[BANDS][ACCUMULATORS];
        for (int band = 0; band < BANDS; ++band)
            for (int a = 0; a < ACCUMULATORS; ++a) sums[band][a] = (real_v)0.0f;
        for (int step = 0; step < kReduceBlock / LANES; ++step) {
            const int patch = block * kReduceBlock + step * LANES;
#ifdef FORM_FACTOR_ANALYTIC
            const real_v form_factor = take_form_factors(shot, factors, stride, patch);
#else
            const real_v form_factor =
                take_counts(proxel_count, proxels_shot, patch, &summary.proxels);
#endif
            shoot_at(shot, shot_flux, stride, patch, form_factor, received, received_rest, unshot,
                     reflectance);
            real_v energy = (real_v)0.0f;
            for (int band = 0; band < BANDS; ++band) {
                const real_v left = load_v(band * stride + patch, unshot);
                energy = fma((real_v)band_weight[band], left, energy);
                sums[band][step % ACCUMULATORS] += left;
            }
            for (int lane = 0; lane < LANES; ++lane)
                if (lane_of(energy, lane) > summary.energy) {
                    summary.energy = lane_of(energy, lane);
                    summary.patch = patch + lane;
                }
        }
        summaries[block] = summary;
        for (int band = 0; band < BANDS; ++band)
            block_unshot[block * BANDS + band] = total_of(sums[band]);
    }
}
