// progress.clh, shown to a test: what each group of a launch works on, [group][member, station, share],
// and where all work on the same, each work-item, [work-item][PE, count].
#include "progress.clh"

__kernel void deal(const __global Shot* salvo, __global int* parts) {
    const Part part = own_part(salvo, projecting_members(salvo));
    __global int* to = parts + 3 * get_group_id(0);
    to[0] = part.member;
    to[1] = part.station;
    to[2] = part.share;
}

__kernel void place(__global int* places) {
    const Place own = own_place();
    places[2 * get_global_id(0)] = own.pe;
    places[2 * get_global_id(0) + 1] = own.count;
}
