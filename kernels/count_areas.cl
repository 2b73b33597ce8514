// Sec. 1.5.5: only areas that a bounding rectangle touches are visited. First half of a counting
// sort of the patches by tile: each PE counts how many of its patches touch each tile.
// entries: [tile][PE].
#include "progress.clh"
#include "tiles.clh"

__kernel void count_areas(const __global Shot* shot, const __global Projection* projections,
                          const __global int* projection_count, int depth, __global int* entries) {
    if (!is_projecting(shot)) return;
    const int pe = get_global_id(0), pe_count = get_global_size(0);
    for (int tile = 0; tile < TILE_COLUMNS * TILE_ROWS; ++tile) entries[tile * pe_count + pe] = 0;
    const __global Projection* mine = projections + pe * depth;
    for (int slot = 0; slot < projection_count[pe]; ++slot) {
        const TileSpan span = tile_span(mine[slot].columns, mine[slot].rows);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                ++entries[(row * TILE_COLUMNS + column) * pe_count + pe];
    }
}
