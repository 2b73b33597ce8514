// Final gather (ours): hemispheres at points of surfaces instead of on shooters, for each member of the
// salvo the next of the points from `first` on. One that the last salvo's lists had no room for halts
// all that come behind it.
#include "progress.clh"
#include "shared.h"

static bool is_halted(const __global Shot* salvo) {
    for (int member = 0; member < MEMBERS; ++member)
        if (salvo[member].status != kRunning) return true;
    return false;
}

static void copy_axis(const __global float* from, __global float* to) {
    for (int axis = 0; axis < 3; ++axis) to[axis] = from[axis];
}

__kernel void aim_points(__global Shot* salvo, const __global GatherPoint* points, int first,
                         int end) {
    if (is_halted(salvo)) return;
    const int member = get_global_id(0), next = first + member;
    __global Shot* shot = salvo + member;
    const bool is_aimed = member < SALVO && next < end;
    shot->shooter = is_aimed ? next : -1;
    shot->row_known = !is_aimed;
    shot->part = shot->part_count = 1;
    shot->is_done = shot->is_ahead = 0;
    if (!is_aimed) return;
    const __global GatherPoint* point = points + next;
    shot->plane = point->plane;
    shot->reached = point->reached;
    for (int axis = 0; axis < 3; ++axis) shot->origin[axis] = point->origin[axis];
    copy_axis(point->u_axis, shot->u_axis);
    copy_axis(point->v_axis, shot->v_axis);
    copy_axis(point->normal, shot->normal);
}
