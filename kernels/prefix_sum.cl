// Turns counts into the places where lists begin: exclusive prefix sum, in place, by one array.
// More entries than `capacity` halt the shot; the host then enlarges the buffer and repeats it.
#include "progress.clh"
#include "shared.h"

// PoCL 3.1 miscompiles a kernel whose work-items may leave before a barrier, so all of them stay.
__kernel void prefix_sum(__global Shot* shot, __global int* values, int count, uint capacity) {
    __local uint sums[PREFIX_PES];
    const int pe = get_local_id(0);
    const bool running = is_projecting(shot);
    const int share = running ? (count + PREFIX_PES - 1) / PREFIX_PES : 0;
    const int first = min(pe * share, count), end = min(first + share, count);
    uint sum = 0;
    for (int i = first; i < end; ++i) sum = add_sat(sum, (uint)values[i]);
    sums[pe] = sum;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);  // all have read the status by now

    uint before = 0;
    for (int other = 0; other < pe; ++other) before = add_sat(before, sums[other]);
    for (int i = first; i < end; ++i) {
        const int value = values[i];
        values[i] = before;
        before = add_sat(before, (uint)value);
    }
    if (running && pe == PREFIX_PES - 1) {
        shot->bin_entries = before;
        if (before > capacity) shot->status = kBinsFull;
    }
}
