// Sec. 1.5.5: second half of the counting sort by tile. Each PE writes the slots of its patches
// to the lists of the tiles they touch, from where prefix_sum says. As PEs hold consecutive patches
// and keep their order, a list ascends by patch. The places are spent.
#include "progress.clh"
#include "stacks.clh"
#include "tiles.clh"

__kernel void bin_areas(const __global Shot* salvo, const __global Rectangle* rectangles,
                        const __global int* projection_count, int depth, __global int* places,
                        __global int* lists) {
    const Stack own = own_stack(salvo);
    if (own.member < 0) return;
    __global int* mine = places + own.place * TILE_COUNT;
    const int end = own.place * depth + projection_count[own.place];
    for (int slot = own.place * depth; slot < end; ++slot) {
        const TileSpan span = tile_span(rectangles[slot]);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                lists[mine[row * TILE_COLUMNS + column]++] = slot;
    }
}
