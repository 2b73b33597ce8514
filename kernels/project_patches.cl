// Sec. 1.5.3: the projection step. One array of PEs holds a tile of the plane and takes the
// patches that touch it, a batch at a time (the ACU's diffusion), all PEs the same patch at once.
// A PE's activity flag is the sign of every arc (app. A); depth by the true distance (app. A).
// The loops of sec. 1.5.4 "for each patch, for each area" are exchanged: tiles are independent.
#include "activity.clh"
#include "coverage.clh"
#include "evaluate.clh"
#include "hemisphere.clh"
#include "plane.clh"
#include "progress.clh"
#include "sum_form_factors.clh"

// Diffuses patches of the tile's list to the array: one, a batch, or a level of the stacks at a
// time (BROADCAST_PATCHES), of `left` that are still to come.
static void broadcast(const __global Projection* projections,
                      const __global Rectangle* rectangles, const __global int* list, int count,
                      int left, int pe, __local Projection* batch, __local Rectangle* batch_rectangles) {
    for (int k = pe; k < count; k += PE_COUNT) {
        batch[k] = projections[list[k]];
        batch_rectangles[k] = rectangles[list[k]];
    }
    for (int k = count + pe; k < min(count + BROADCAST_PATCHES, left); k += PE_COUNT) {
        fetch_ahead(projections + list[k]);
        fetch_ahead(rectangles + list[k]);
    }
}

// Depth planes are A" u + B" v + C" w; Spencer's constant distance (app. A) comes as A" alone.
#ifdef DISTANCE_CONSTANT
#define first_depth(depth, u, v) first_linear(0.0f, 0.0f, (depth)[0], u, v)
#else
#define first_depth(depth, u, v) first_linear((depth)[0], (depth)[1], 0.0f, u, v)
#endif

// One patch in one column of areas: each PE evaluates its proxels of the rows that the bounding
// rectangle touches. A proxel is inside where no arc's value has its sign bit set: where the least
// of their bits, as integers, has not. Outside the
// rectangle it never is: beyond a sharp corner the arcs' margins reach farther than the
// rectangle's, and which proxels are evaluated there depends on the array.
static void project(const __local Projection* patch, const __local Rectangle* of, int tile,
                    int area_column, int pe, const __global real_v* roots, __local real_v* depth,
                    __local int_v* owner, Activity* activity, Coverage* coverage) {
    const int column = proxel_column(tile, area_column, pe);
    if (column > last_of(of->columns) || column + LANES <= first_of(of->columns)) return;
    const int_v columns = column + LANE_INDEX;
    const real_v u = to_real_v(centre_numerator(columns)) * (1.0f / RESOLUTION);
    const int_v in_columns = at_least_v(columns, first_of(of->columns)) &
                             at_least_v((int_v)last_of(of->columns), columns);
    const int first = first_area_row(of->rows, tile, pe);
    const int last = last_area_row(of->rows, tile, pe);
    const float v_first = row_centre(proxel_row(tile, first, pe));
    real_v edge[CORNERS];
    UNROLLED for (int k = 0; k < CORNERS; ++k)
        edge[k] = first_linear(patch->edge[k][0], patch->edge[k][1], kEdgeMargin, u, v_first);
    real_v depth_linear = first_depth(patch->depth, u, v_first);

    for (int area_row = first; area_row <= last; ++area_row) {
        const int row = proxel_row(tile, area_row, pe);
        const int at = plural_index(area_row * AREA_COLUMNS + area_column, pe);
        const float v = row_centre(row);
        const real_v root = roots[at], nearest = depth[at];
        int_v least = INT_MAX;
        UNROLLED for (int k = 0; k < CORNERS; ++k) {
            least = min(least, as_int_v(value_at(patch->edge[k][1], patch->edge[k][2], edge[k], v,
                                                 root)));
            edge[k] = next_linear(edge[k], patch->edge[k][1]);
        }
        const int_v inside = at_least_v(least, (int_v)0) & in_columns & is_in(row, of->rows);
        const int_v certain = well_inside(least, inside);
        const real_v distance =
            value_at(patch->depth[1], patch->depth[2], depth_linear, v, root);
        depth_linear = next_linear(depth_linear, patch->depth[1]);
        const int_v nearer = inside & less_v(distance, nearest);
        depth[at] = choose_v(nearer, distance, nearest);
        owner[at] = select(owner[at], claim_of(patch->patch, certain), nearer);
        count_useful(activity, inside, root);
        count_covered(coverage, certain, root);
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

__kernel __attribute__((reqd_work_group_size(PE_COUNT, 1, 1))) void project_patches(
    const __global Shot* salvo, const __global real_v* roots,
    const __global Projection* projections, const __global Rectangle* rectangles,
    const __global int* list_ends, const __global int* lists, uint capacity, int escaped,
    __global int* proxel_counts, __global int* covered_counts, __global int_v* owners,
    __global uint* activity_totals) {
    __local real_v depth[TILE_VECTORS];
    __local int_v owner[TILE_VECTORS];
    __local Projection batch[BROADCAST_PATCHES];
    __local Rectangle batch_rectangles[BROADCAST_PATCHES];
#ifdef ACCUMULATE_XNET
    __local int wire[PE_COUNT];
#endif
    const int pe = get_local_id(0);
    const Part own = own_part(salvo, projecting_members(salvo));
    // No work-item may leave before a barrier, see prefix_sum.cl: a halted shot has empty lists.
    const bool running = own.member >= 0;
    const int tile = own.share, station = own.station;
    const __global real_v* tile_roots = roots + tile * TILE_VECTORS;
    const __global int* list_end = list_ends + station * TILE_COUNT;
    __global int* proxel_count = proxel_counts + station * (escaped + kCountsGap);
    __global int* covered_count = covered_counts + station * escaped;

    Activity activity = no_activity();
    if (running) clear_plane(pe, escaped, tile_roots, depth, owner);
    const int begin = !running ? 0 : tile != 0 ? list_end[tile - 1] : (int)(station * capacity);
    const int end = running ? list_end[tile] : 0;
    for (int first = begin; first < end; first += BROADCAST_PATCHES) {
        const int count = min(BROADCAST_PATCHES, end - first);
        barrier(CLK_LOCAL_MEM_FENCE);
        broadcast(projections, rectangles, lists + first, count, end - first, pe, batch,
                  batch_rectangles);
        barrier(CLK_LOCAL_MEM_FENCE);
        for (int k = 0; k < count; ++k) {
            count_visit(&activity, batch_rectangles + k, tile, pe);
            Coverage coverage = no_coverage();
            for (int area_column = 0; area_column < AREA_COLUMNS; ++area_column)
                project(batch + k, batch_rectangles + k, tile, area_column, pe, tile_roots, depth,
                        owner, &activity, &coverage);
            add_coverage(coverage, batch[k].patch, covered_count);
        }
    }
    add_activity(&activity, activity_totals);
#ifdef ACCUMULATE_XNET
    sum_by_xnet(owner, pe, projections, lists + begin, end - begin, wire, proxel_count);
    if (running) {
        atomic_add(proxel_count + escaped, owned_by(owner, pe, escaped));
        atomic_add(proxel_count + escaped + 2, marginal_claims(owner, pe));
    }
#else
    if (running) sum_by_histogram(owner, pe, escaped, proxel_count);
#endif
#ifdef KEEP_OWNERS
    __global int_v* kept = owners + (station * TILE_COUNT + tile) * TILE_VECTORS;
    for (int layer = 0; layer < (running ? LAYERS : 0); ++layer)
        kept[plural_index(layer, pe)] = owner_of(owner[plural_index(layer, pe)]);
#endif
}
