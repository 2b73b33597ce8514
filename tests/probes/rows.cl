// rows.clh, shown to a test: PEs keep the blocks of rows, [row][patch], where `places` says, and fetch
// them again.
#include "rows.clh"

__kernel void keep(const __global float* values, int row_count, int stride,
                   const __global int* places, __global uint* words, __global RowPool* pool,
                   __global Extent* extents) {
    const int pe = get_global_id(0);
    const Rows rows = {words, pool, extents + pe};
    const Blocks blocks = own_blocks(pe, get_global_size(0), stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block)
        for (int row = 0; row < row_count; ++row)
            keep_block(&rows, places[row], block, values + row * stride + block * kReduceBlock);
}

__kernel void fetch(__global float* values, int row_count, int stride, const __global int* places,
                    __global uint* words, __global RowPool* pool, __global Extent* extents) {
    const int pe = get_global_id(0);
    const Rows rows = {words, pool, extents + pe};
    const Blocks blocks = own_blocks(pe, get_global_size(0), stride / kReduceBlock);
    for (int block = blocks.first; block < blocks.end; ++block)
        for (int row = 0; row < row_count; ++row)
            fetch_block(&rows, places[row], block, values + row * stride + block * kReduceBlock);
}
