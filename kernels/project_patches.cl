// Sec. 1.5.3: the projection step. One array of PEs holds a tile of the plane and takes the
// patches that touch it, a batch at a time (the ACU's diffusion), all PEs the same patch at once.
// A PE's activity flag is the sign of every arc (app. A); depth by the true distance (app. A).
// The loops of sec. 1.5.4 "for each patch, for each area" are exchanged: tiles are independent.
#include "hemisphere.clh"
#include "plane.clh"
#include "sum_form_factors.clh"

#define PROJECTION_WORDS (sizeof(Projection) / sizeof(int))

// Diffuses up to kBroadcastBatch patches of the tile's list to the array.
static void broadcast(const __global Projection* projections, const __global int* list, int count,
                      int pe, __local Projection* batch) {
    for (int word = pe; word < count * (int)PROJECTION_WORDS; word += PE_COUNT)
        ((__local int*)batch)[word] =
            ((const __global int*)(projections + list[word / PROJECTION_WORDS]))
                [word % PROJECTION_WORDS];
}

// One patch in one column of areas: each PE evaluates its proxels of the rows that the bounding
// rectangle touches.
static void project(const __local Projection* patch, int tile, int area_column, int pe,
                    const __global real_v* roots, __local real_v* depth, __local int_v* owner) {
    const int column = proxel_column(tile, area_column, pe);
    if (column > last_of(patch->columns) || column + LANES <= first_of(patch->columns)) return;
    const real_v u = to_real_v(centre_numerator(column + LANE_INDEX)) * (1.0f / RESOLUTION);
    real_v edge_u[CORNERS];
    UNROLLED for (int k = 0; k < CORNERS; ++k)
        edge_u[k] = fma((real_v)patch->edge[k][0], u, (real_v)kEdgeMargin);
    const real_v depth_u = patch->depth[0] * u;

    const int tile_row = proxel_row(tile, 0, 0);
    const int first = max(first_of(patch->rows) - tile_row, 0) / AREA_HEIGHT;
    const int last = min(last_of(patch->rows) - tile_row, TILE_HEIGHT - 1) / AREA_HEIGHT;
    for (int area_row = first; area_row <= last; ++area_row) {
        const int at = plural_index(area_row * AREA_COLUMNS + area_column, pe);
        const float v = (2 * proxel_row(tile, area_row, pe) + 1 - RESOLUTION) * (1.0f / RESOLUTION);
        const real_v root = roots[at];
        int_v outside = 0;  // the sign bit of any arc's value
        UNROLLED for (int k = 0; k < CORNERS; ++k)
            outside |= as_int_v(fma((real_v)patch->edge[k][2], root,
                                    fma((real_v)patch->edge[k][1], (real_v)v, edge_u[k])));
        const real_v distance = fma((real_v)patch->depth[2], root,
                                    fma((real_v)patch->depth[1], (real_v)v, depth_u));
        const real_v nearest = depth[at];
        const int_v nearer = less_v(distance, nearest) & ~(outside >> 31);
        depth[at] = choose_v(nearer, distance, nearest);
        owner[at] = select(owner[at], (int_v)patch->patch, nearer);
    }
}

// Proxels begin as `escaped`, at infinity where -1/rho = 0; those outside the disk belong to
// escaped + 1, nearer than any patch.
static void clear_plane(int pe, int escaped, const __global real_v* roots, __local real_v* depth,
                        __local int_v* owner) {
    for (int layer = 0; layer < LAYERS; ++layer) {
        const int at = plural_index(layer, pe);
        const int_v in_disk = less_v((real_v)0.0f, roots[at]);
        depth[at] = choose_v(in_disk, (real_v)0.0f, (real_v)-INFINITY);
        owner[at] = select((int_v)(escaped + 1), (int_v)escaped, in_disk);
    }
}

__kernel void project_patches(const __global Shot* shot, const __global real_v* roots,
                              const __global Projection* projections, const __global int* list_end,
                              const __global int* lists, int stack_count, int escaped,
                              __global int* proxel_count, __global int_v* owners) {
    __local real_v depth[TILE_VECTORS];
    __local int_v owner[TILE_VECTORS];
    __local Projection batch[kBroadcastBatch];
    const int tile = get_group_id(0), pe = get_local_id(0);
    const __global real_v* tile_roots = roots + tile * TILE_VECTORS;

    clear_plane(pe, escaped, tile_roots, depth, owner);
    // No work-item may leave before a barrier, see prefix_sum.cl: a halted shot has empty lists.
    const bool running = shot->status == kRunning;
    const int begin = running && tile != 0 ? list_end[tile * stack_count - 1] : 0;
    const int end = running ? list_end[(tile + 1) * stack_count - 1] : 0;
    for (int first = begin; first < end; first += kBroadcastBatch) {
        const int count = min(kBroadcastBatch, end - first);
        barrier(CLK_LOCAL_MEM_FENCE);
        broadcast(projections, lists + first, count, pe, batch);
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int k = 0; k < count; ++k)
            for (int area_column = 0; area_column < AREA_COLUMNS; ++area_column)
                project(batch + k, tile, area_column, pe, tile_roots, depth, owner);
    }
    if (running) sum_form_factors(owner, pe, proxel_count);
#ifdef KEEP_OWNERS
    for (int layer = 0; layer < LAYERS; ++layer)
        owners[tile * TILE_VECTORS + plural_index(layer, pe)] = owner[plural_index(layer, pe)];
#endif
}
