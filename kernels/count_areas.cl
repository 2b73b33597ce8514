// Sec. 1.5.5: only areas that a bounding rectangle touches are visited. First half of a counting
// sort of the patches by tile: each PE counts how many of its patches touch each tile.
// entries: [station][PE][tile].
#include "progress.clh"
#include "stacks.clh"
#include "tiles.clh"

__kernel void count_areas(const __global Shot* salvo, const __global Rectangle* rectangles,
                          const __global int* projection_count, int depth, __global int* entries) {
    const Stack own = own_stack(salvo);
    if (own.member < 0) return;
    __global int* mine = entries + own.place * TILE_COUNT;
    for (int tile = 0; tile < TILE_COUNT; ++tile) mine[tile] = 0;
    const int end = own.place * depth + projection_count[own.place];
    for (int slot = own.place * depth; slot < end; ++slot) {
        const TileSpan span = tile_span(rectangles[slot]);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                ++mine[row * TILE_COLUMNS + column];
    }
}
