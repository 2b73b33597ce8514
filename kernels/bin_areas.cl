// Sec. 1.5.5: second half of the counting sort by tile. Each PE writes the slots of its patches
// to the lists of the tiles they touch, from where prefix_sum says. As PEs hold consecutive patches
// and keep their order, a list ascends by patch. The places are spent.
#include "progress.clh"
#include "stacks.clh"
#include "tiles.clh"

__kernel void bin_areas(const __global Shot* shot, const __global Rectangle* rectangles,
                        const __global int* projection_count, int depth, __global int* places,
                        __global int* lists) {
    if (!is_projecting(shot)) return;
    const int pe = own_stack();
    __global int* mine = places + pe * TILE_COUNT;
    const int end = pe * depth + projection_count[pe];
    for (int slot = pe * depth; slot < end; ++slot) {
        const TileSpan span = tile_span(rectangles[slot]);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                lists[mine[row * TILE_COLUMNS + column]++] = slot;
    }
}
