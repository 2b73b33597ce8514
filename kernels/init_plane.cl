// Sec. 1.5.3: the square root of eq. 1.2 depends on the proxel alone; it is computed once.
#include "hemisphere.clh"
#include "plane.clh"

__kernel __attribute__((reqd_work_group_size(PE_COUNT, 1, 1))) void init_plane(
    __global real_v* roots) {
    const int tile = get_group_id(0), pe = get_local_id(0);
    for (int layer = 0; layer < LAYERS; ++layer)
        roots[tile * TILE_VECTORS + plural_index(layer, pe)] = root_at(
            centre_numerator(proxel_column(tile, layer % AREA_COLUMNS, pe) + LANE_INDEX),
            centre_numerator((int_v)proxel_row(tile, layer / AREA_COLUMNS, pe)));
}
