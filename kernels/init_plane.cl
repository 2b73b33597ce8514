// Sec. 1.5.3: the square root of eq. 1.2 depends on the proxel alone; it is computed once. It is
// 0 for proxels whose centre lies outside the disk, and nowhere else: the disk is decided in
// integers.
#include "hemisphere.clh"
#include "plane.clh"

__kernel void init_plane(__global real_v* roots) {
    const int tile = get_group_id(0), pe = get_local_id(0);
    for (int layer = 0; layer < LAYERS; ++layer) {
        const int_v a = centre_numerator(proxel_column(tile, layer % AREA_COLUMNS, pe) + LANE_INDEX);
        const int b = 2 * proxel_row(tile, layer / AREA_COLUMNS, pe) + 1 - RESOLUTION;
        const int_v squared = RESOLUTION * RESOLUTION - b * b - a * a;
        const real_v root = sqrt(to_real_v(squared)) / (real_v)RESOLUTION;
        roots[tile * TILE_VECTORS + plural_index(layer, pe)] =
            choose_v((int_v)0 < squared, root, (real_v)0.0f);
    }
}
