// Sec. 1.5.4: every patch adds the flux that its form factor brings it, by the reciprocity of
// eq. 1.1: F_ji B_i A_j = F_ij A_i B_i, so fluxes need no areas. A shooter's row of form factors is
// what its hemispheres counted, or what an earlier shot of it left in `rows`. Nothing is done before
// the last hemisphere of all that shoot at once.
// shot_rows: [shooter][patch], of this shot. received, received_rest: [band][patch]; shot_flux: [shooter][band]; flux in
// normalised units.
#include "compensated.clh"
#include "form_factors.clh"
#include "rows.clh"
#include "salvo.clh"

// Where the members' form factors are, and what becomes of them.
typedef struct {
    __global int* proxel_counts;
    __global float* factors;
    int disk_proxels, stride;
} Sources;

// What a member's hemispheres saw of LANES patches; that is spent.
static real_v seen_form_factors(const Sources* from, const __global Shot* shot, int station,
                                int patch, int* owned) {
#ifdef FORM_FACTOR_ANALYTIC
    return take_form_factors(shot, from->factors + station * kFactorKinds * from->stride,
                             from->stride, patch);
#else
    const float proxels_shot = from->disk_proxels * max(shot->part_count, 1u);
    return take_counts(from->proxel_counts + station * (from->stride + kCountsGap), proxels_shot,
                       patch, owned);
#endif
}

// A block's form factors of all members, [member][pitch]; those that look ahead share the place behind
// the last. New rows are kept where they have a place. owned: [station], proxels that the patches own.
static void salvo_form_factors(const __global Shot* salvo, int shooters, int size,
                               const Sources* from, const Rows* rows, int block,
                               __global float* form_factors, int pitch, int* owned) {
    int station = 0;
    for (int member = 0; member < size; ++member) {
        const __global Shot* shot = salvo + member;
        __global float* own = form_factors + (size_t)min(member, shooters) * pitch;
        if (shot->row_known) {
            fetch_block(rows, shot->row, block, own);
            continue;
        }
        for (int step = 0; step < BLOCK_VECTORS; ++step)
            *real_vectors(own + step * LANES) = seen_form_factors(
                from, shot, station, block * kReduceBlock + step * LANES, owned + station);
        if (shot->row != 0) keep_block(rows, shot->row, block, own);
        ++station;
    }
}

// To LANES patches, [shooter]; places as salvo_form_factors() leaves them.
static void load_form_factors(const __global float* form_factors, int pitch, int shooters,
                              real_v* form_factor) {
    for (int member = 0; member < shooters; ++member)
        form_factor[member] = load_v((size_t)member * pitch, form_factors);
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
                               __global float* factors, int stride, __global uint* row_words,
                               __global RowPool* pool, __global Extent* extents,
                               __global float* shot_rows, __global float* received,
                               __global float* received_rest) {
    const Place own = own_place();
    if (own.pe < 0 || !is_shooting(salvo)) return;
    const int size = salvo_size(salvo), shooters = shooter_count(salvo);
    const Sources from = {proxel_counts, factors, disk_proxels, stride};
    const Rows rows = {row_words, pool, extents + own.pe};
    int owned[SALVO] = {0};
    const Blocks blocks = own_blocks(own.pe, own.count, stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block) {
        __global float* form_factors = shot_rows + block * kReduceBlock;
        salvo_form_factors(salvo, shooters, size, &from, &rows, block, form_factors, stride, owned);
        for (int step = 0; step < BLOCK_VECTORS; ++step) {
            real_v form_factor[SALVO];
            load_form_factors(form_factors + step * LANES, stride, shooters, form_factor);
            receive(form_factor, shooters, shot_flux, stride, block * kReduceBlock + step * LANES,
                    received, received_rest);
        }
    }
    add_owned(owned, stride, proxel_counts);
}
