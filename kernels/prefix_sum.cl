// Turns counts, [station][PE][tile], into the places where each PE's part of a tile's list begins,
// in place, and says where each tile's list ends, [station][tile]: a station's lists lie one behind
// another, tile by tile and PE by PE, from station * capacity on. By one array a station. More
// entries than `capacity` halt the shot; the host then enlarges the buffer and repeats it.
#include "progress.clh"
#include "tiles.clh"

// PoCL 3.1 miscompiles a kernel whose work-items may leave before a barrier, so all of them stay.
__kernel __attribute__((reqd_work_group_size(PREFIX_PES, 1, 1))) void prefix_sum(
    __global Shot* salvo, __global int* restrict all_counts, int stack_count,
    __global int* restrict list_ends, uint capacity) {
    __local ulong sums[PREFIX_PES];
    const int pe = get_local_id(0), station = get_group_id(0);
    const int member = member_at(salvo, projecting_members(salvo), station);
    const bool running = member >= 0;
    __global Shot* shot = salvo + max(member, 0);
    __global int* restrict counts = all_counts + station * stack_count * TILE_COUNT;
    __global int* restrict list_end = list_ends + station * TILE_COUNT;
    const int share = running ? (TILE_COUNT + PREFIX_PES - 1) / PREFIX_PES : 0;
    const int first = min(pe * share, TILE_COUNT), end = min(first + share, TILE_COUNT);
    for (int tile = first; tile < end; ++tile) list_end[tile] = 0;
    for (int stack = 0; stack < stack_count; ++stack)
        for (int tile = first; tile < end; ++tile)
            list_end[tile] += counts[stack * TILE_COUNT + tile];
    ulong sum = 0;
    for (int tile = first; tile < end; ++tile) sum += list_end[tile];
    sums[pe] = sum;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);  // all have read the status by now

    ulong all = 0, before = 0;
    for (int other = 0; other < PREFIX_PES; ++other) {
        before += other < pe ? sums[other] : 0;
        all += sums[other];
    }
    if (running && pe == 0) {
        shot->bin_entries = min(all, (ulong)UINT_MAX);
        if (all > capacity) shot->status = kBinsFull;
    }
    if (all > capacity) return;  // behind the last barrier
    before += (ulong)station * capacity;

    for (int tile = first; tile < end; ++tile) {
        const int of_tile = list_end[tile];
        list_end[tile] = before;
        before += of_tile;
    }
    for (int stack = 0; stack < stack_count; ++stack)
        for (int tile = first; tile < end; ++tile) {
            const int place = list_end[tile];
            list_end[tile] += counts[stack * TILE_COUNT + tile];
            counts[stack * TILE_COUNT + tile] = place;
        }
}
