// Sec. 1.5.5: second half of the counting sort by tile. Each PE writes the slots of its patches
// to the lists of the tiles they touch. As PEs hold consecutive patches and keep their order, a
// list ascends by patch. Afterwards list_end[tile][PE] is where that PE's part of the list ends.
#include "progress.clh"
#include "tiles.clh"

__kernel void bin_areas(const __global Shot* shot, const __global Projection* projections,
                        const __global int* projection_count, int depth, __global int* list_end,
                        __global int* lists) {
    if (!is_projecting(shot)) return;
    const int pe = get_global_id(0), pe_count = get_global_size(0);
    const __global Projection* mine = projections + pe * depth;
    for (int slot = 0; slot < projection_count[pe]; ++slot) {
        const TileSpan span = tile_span(mine[slot].columns, mine[slot].rows);
        for (int row = span.first_row; row <= span.last_row; ++row)
            for (int column = span.first_column; column <= span.last_column; ++column)
                lists[list_end[(row * TILE_COLUMNS + column) * pe_count + pe]++] =
                    pe * depth + slot;
    }
}
