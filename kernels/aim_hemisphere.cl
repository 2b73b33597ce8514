// Sec. 1.5.2: the coordinate system of the source patch, its origin in the next of samples x
// samples equal parts of it. A hemisphere at a patch's centre gives a point-to-area factor;
// several on the patch approach the area-to-area factor.
#include "progress.clh"
#include "shared.h"

#pragma OPENCL FP_CONTRACT OFF

// The disk is turned against the patch's first edge by 15 to 75 degrees: else the edges of a
// rectangular room run through rows of proxel centres, and ties, which all go to the lowest patch,
// bias its form factors (0.3 % in a furnace at 512^2). Every hemisphere turns it otherwise, as the
// multiples of two irrational numbers (the plastic number's, in units of 2^-32) spread evenly, so
// that aliasing is not the same for all that shoot at an edge.
static float disk_angle(int patch, int part) {
    const uint turn = (uint)(patch + 1) * 3242174889u + (uint)part * 2447445414u;
    return (1.0f / 12 + turn * (1.0f / 3 / 4294967296.0f)) * M_PI_F;
}

static int3 corner_of(const __global int* corners, int stride, int patch, int k) {
    const __global int* at = corners + 3 * k * stride + patch;
    return (int3)(at[0], at[stride], at[2 * stride]);
}

// Points of a patch are weights of its four corners, which add up to 1.
static float3 point_of(const float3* corner, float4 weights) {
    return corner[0] * weights.x + corner[1] * weights.y + corner[2] * weights.z +
           corner[3] * weights.w;
}

// Sample `part` of a triangle: the centroid of one of its samples^2 congruent parts, in rows of
// 1, 3, 5, ... from corner a.
static float4 triangle_sample(int part, int samples) {
    int row = 0;
    while ((row + 1) * (row + 1) <= part) ++row;
    const int along = part - row * row;
    // Centroids in thirds of a step: upright parts (even `along`) and inverted ones alternate.
    const float down = (row + ((along & 1) != 0 ? 1.0f / 3.0f : 2.0f / 3.0f)) / samples;
    const float across = (along / 2 + ((along & 1) != 0 ? 2.0f / 3.0f : 1.0f / 3.0f)) / samples;
    return (float4)(1.0f - down, down - across, across, 0.0f);
}

static float4 quad_point(float s, float t) {
    return (float4)((1.0f - s) * (1.0f - t), s * (1.0f - t), s * t, (1.0f - s) * t);
}

// Where a density that runs linearly from `low` at 0 to `high` at 1 has the share q below it.
static float quantile(float low, float high, float q) {
    const float root = sqrt(low * low + q * (high * high - low * low));
    return low + root > 0.0f ? q * (low + high) / (low + root) : q;
}

// Centroid of the quad between four points of a patch: that of its two triangles by their areas.
static float4 quad_centroid(const float3* corner, float4 a, float4 b, float4 c, float4 d) {
    const float3 from = point_of(corner, a), across = point_of(corner, c) - from;
    const float lower = length(cross(point_of(corner, b) - from, across));
    const float upper = length(cross(across, point_of(corner, d) - from));
    const float share = lower + upper > 0.0f ? lower / (lower + upper) : 0.5f;
    return ((a + c) + (b * share + d * (1.0f - share))) * (1.0f / 3.0f);
}

// Sample `part` of a quad: the centroid of one of samples^2 parts of equal area. The area of the
// bilinear map's cells is linear in s and t, so rows and then cells end at quantiles of it.
static float4 quad_sample(const float3* corner, int part, int samples) {
    const float3 low = corner[1] - corner[0], high = corner[2] - corner[3];
    const float3 left = corner[3] - corner[0], right = corner[2] - corner[1];
    const float area00 = length(cross(low, left)), area10 = length(cross(low, right));
    const float area01 = length(cross(high, left)), area11 = length(cross(high, right));
    const int row = part / samples, column = part % samples;
    const float t0 = quantile(area00 + area10, area01 + area11, (float)row / samples);
    const float t1 = quantile(area00 + area10, area01 + area11, (float)(row + 1) / samples);
    const float t = 0.5f * (t0 + t1);
    const float at_left = mix(area00, area01, t), at_right = mix(area10, area11, t);
    const float s0 = quantile(at_left, at_right, (float)column / samples);
    const float s1 = quantile(at_left, at_right, (float)(column + 1) / samples);
    return quad_centroid(corner, quad_point(s0, t0), quad_point(s1, t0), quad_point(s1, t1),
                         quad_point(s0, t1));
}

// The grid's point nearest to the sample. In whole numbers, so that it lies in the patch's plane as
// well as a corner does: weights may be rounded, as long as they add up to 1.
static int3 on_grid(const int3* corner, float4 sample) {
    const int4 weights = convert_int4_rte(sample * 16777216.0f);
    const long3 sum = (long)weights.y * convert_long3(corner[1] - corner[0]) +
                      (long)weights.z * convert_long3(corner[2] - corner[0]) +
                      (long)weights.w * convert_long3(corner[3] - corner[0]);
    return corner[0] + convert_int3((sum + 8388608L) >> 24L);
}

// The first edge, unless a repeated corner has left it without direction.
static float3 proper_edge(const float3* corner) {
    float3 edge = corner[1] - corner[0];
    for (int k = 1; k < 4; ++k)
        edge = dot(edge, edge) > 0.0f ? edge : corner[(k + 1) % 4] - corner[k];
    return edge;
}

// Along an edge, as far as the plane allows; where the grid has left a patch no edge in its plane,
// across the axis that is farthest from the normal.
static float3 frame_axis(float3 edge, float3 normal) {
    const float3 along = edge - normal * dot(edge, normal);
    if (dot(along, along) > 0.25f * dot(edge, edge)) return normalize(along);
    const float3 upright = fabs(normal);
    const float3 axis = upright.x <= min(upright.y, upright.z)   ? (float3)(1.0f, 0.0f, 0.0f)
                        : upright.y <= upright.z ? (float3)(0.0f, 1.0f, 0.0f)
                                                 : (float3)(0.0f, 0.0f, 1.0f);
    return normalize(cross(normal, axis));
}

static void store_axis(float3 axis, __global float* to) {
    to[0] = axis.x;
    to[1] = axis.y;
    to[2] = axis.z;
}

__kernel void aim_hemisphere(__global Shot* salvo, const __global int* corners,
                             const __global float* normals, const __global int* planes,
                             const __global int* reached, int stride,
                             const __global int* shooter_samples) {
    __global Shot* shot = salvo + get_global_id(0);
    if (!is_projecting(shot)) return;
    const int shooter = shot->shooter, samples = shooter_samples[shooter], part = shot->part;
    shot->is_done = part == samples * samples;
    if (shot->is_done) return;
    ++shot->part;
    shot->part_count = samples * samples;
    int3 steps[4];
    float3 corner[4];  // from the first one: as exact as the patch is small
    for (int k = 0; k < 4; ++k) {
        steps[k] = corner_of(corners, stride, shooter, min(k, CORNERS - 1));
        corner[k] = kGridStep * convert_float3(steps[k] - steps[0]);
    }
    const bool triangle = all(steps[3] == steps[2]);
    const int3 origin = on_grid(steps, triangle ? triangle_sample(part, samples)
                                                : quad_sample(corner, part, samples));
    shot->plane = planes[shooter];
    shot->reached = reached[shooter];
    shot->origin[0] = origin.x;
    shot->origin[1] = origin.y;
    shot->origin[2] = origin.z;

    const float3 normal =
        (float3)(normals[shooter], normals[stride + shooter], normals[2 * stride + shooter]);
    const float3 along = frame_axis(proper_edge(corner), normal);
    const float angle = disk_angle(shooter, part);
    const float3 u_axis = cos(angle) * along + sin(angle) * cross(normal, along);
    store_axis(u_axis, shot->u_axis);
    store_axis(cross(normal, u_axis), shot->v_axis);
    store_axis(normal, shot->normal);
}
