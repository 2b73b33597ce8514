// Sec. 1.5.4: every patch adds the flux that its form factor brings it, by the reciprocity of
// eq. 1.1: F_ji B_i A_j = F_ij A_i B_i, so fluxes need no areas. A shooter's row of form factors is
// what its hemispheres counted, or what an earlier shot of it left in `rows`. Nothing is done before
// the last hemisphere of all that shoot at once.
// rows: [row][patch]. received, received_rest: [band][patch]; shot_flux: [shooter][band]; flux in
// normalised units.
#include "compensated.clh"
#include "form_factors.clh"
#include "salvo.clh"

// A member's form factors to LANES patches; those that were not known are spent.
static real_v form_factor_to_patches(const __global Shot* shot, __global int* proxel_count,
                                     int disk_proxels, __global float* factors, int stride,
                                     const __global float* row, int patch, int* owned) {
    if (shot->row_known) return load_v(patch, row);
#ifdef FORM_FACTOR_ANALYTIC
    return take_form_factors(shot, factors, stride, patch);
#else
    const float proxels_shot = disk_proxels * max(shot->part_count, 1u);
    return take_counts(proxel_count, proxels_shot, patch, owned);
#endif
}

// Of the first `shooters` members to LANES patches: [shooter]. New rows below row_end are kept, of
// those that look ahead as well. owned: [station], proxels that the patches own.
// No more than these vectors are kept at a time: PoCL keeps the private variables of all PEs of an
// array on one thread's stack.
static void salvo_form_factors(const __global Shot* salvo, int shooters, int size,
                               __global int* proxel_counts, int disk_proxels,
                               __global float* factors, int stride, __global float* rows,
                               int row_end, int patch, real_v* form_factor, int* owned) {
    int station = 0;
    for (int member = 0; member < size; ++member) {
        const __global Shot* shot = salvo + member;
        __global float* row = rows + (size_t)shot->row * stride;
        const real_v own = form_factor_to_patches(
            shot, proxel_counts + station * (stride + kCountsGap), disk_proxels,
            factors + station * kFactorKinds * stride, stride, row, patch, owned + station);
        if (member < shooters) form_factor[member] = own;
        if (shot->row_known) continue;
        if (shot->row < row_end) *real_vectors(row + patch) = own;
        ++station;
    }
}

static void receive(const real_v* form_factor, int size, const __global float* shot_flux,
                    int stride, int patch, __global float* received,
                    __global float* received_rest) {
    for (int band = 0; band < BANDS; ++band) {
        const int at = band * stride + patch;
        real_v sum = load_v(at, received), rest = load_v(at, received_rest);
        add_compensated(&sum, &rest, flux_to(form_factor, size, shot_flux, band));
        *real_vectors(received + at) = sum;
        *real_vectors(received_rest + at) = rest;
    }
}

// To the spare counts of each station, see choose_shooter.cl.
static void add_owned(const int* owned, int stride, __global int* proxel_counts) {
    for (int station = 0; station < SALVO; ++station)
        if (owned[station] != 0)
            atomic_add(proxel_counts + station * (stride + kCountsGap) + stride + 2,
                       owned[station]);
}

__kernel void update_radiosity(const __global Shot* salvo, const __global float* shot_flux,
                               __global int* proxel_counts, int disk_proxels,
                               __global float* factors, int stride, __global float* rows,
                               __global float* received, __global float* received_rest) {
    if (!is_shooting(salvo)) return;
    const int size = salvo_size(salvo), shooters = shooter_count(salvo);
    int owned[SALVO] = {0};
    const Blocks blocks = own_blocks(get_global_id(0), get_global_size(0), stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block)
        for (int step = 0; step < BLOCK_VECTORS; ++step) {
            const int patch = block * kReduceBlock + step * LANES;
            real_v form_factor[SALVO];
            salvo_form_factors(salvo, shooters, size, proxel_counts, disk_proxels, factors, stride,
                               rows, INT_MAX, patch, form_factor, owned);
            receive(form_factor, shooters, shot_flux, stride, patch, received, received_rest);
        }
    add_owned(owned, stride, proxel_counts);
}
