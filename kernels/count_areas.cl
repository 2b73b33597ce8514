// Sec. 1.5.5: only areas that a bounding rectangle touches are visited. First half of a counting
// sort of the patches by tile: each PE counts how many of its patches touch each tile.
// entries: [PE][tile].
#include "progress.clh"
#include "stacks.clh"
#include "tiles.clh"

__kernel void count_areas(const __global Shot* shot, const __global Rectangle* rectangles,
                          const __global int* projection_count, int depth, __global int* entries) {
    if (!is_projecting(shot)) return;
    const int pe = own_stack();
    __global int* mine = entries + pe * TILE_COUNT;
    for (int tile = 0; tile < TILE_COUNT; ++tile) mine[tile] = 0;
    const int end = pe * depth + projection_count[pe];
    for (int slot = pe * depth; slot < end; ++slot) {
        const TileSpan span = tile_span(rectangles[slot]);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                ++mine[row * TILE_COLUMNS + column];
    }
}
