// Sec. 1.5.2: the coordinate system of the source patch, its origin in the next of samples x
// samples equal parts of it. A hemisphere at a patch's centre gives a point-to-area factor;
// several on the patch approach the area-to-area factor.
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

static float3 corner_of(const __global float* corners, int stride, int patch, int k) {
    const __global float* at = corners + 3 * k * stride + patch;
    return (float3)(at[0], at[stride], at[2 * stride]);
}

// Sample `part` of a triangle: the centroid of one of its samples^2 congruent parts, in rows of
// 1, 3, 5, ... from corner a.
static float3 triangle_sample(float3 a, float3 b, float3 c, int part, int samples) {
    int row = 0;
    while ((row + 1) * (row + 1) <= part) ++row;
    const int along = part - row * row;
    // Centroids in thirds of a step: upright parts (even `along`) and inverted ones alternate.
    const float down = (row + ((along & 1) != 0 ? 1.0f / 3.0f : 2.0f / 3.0f)) / samples;
    const float across = (along / 2 + ((along & 1) != 0 ? 2.0f / 3.0f : 1.0f / 3.0f)) / samples;
    return a + (b - a) * (down - across) + (c - a) * across;
}

static float3 quad_point(const float3* corner, float s, float t) {
    const float3 low = corner[0] + (corner[1] - corner[0]) * s;
    const float3 high = corner[3] + (corner[2] - corner[3]) * s;
    return low + (high - low) * t;
}

// Where a density that runs linearly from `low` at 0 to `high` at 1 has the share q below it.
static float quantile(float low, float high, float q) {
    const float root = sqrt(low * low + q * (high * high - low * low));
    return low + root > 0.0f ? q * (low + high) / (low + root) : q;
}

// Centroid of a quad: that of its two triangles by their areas.
static float3 quad_centroid(float3 a, float3 b, float3 c, float3 d) {
    const float lower = length(cross(b - a, c - a)), upper = length(cross(c - a, d - a));
    const float share = lower + upper > 0.0f ? lower / (lower + upper) : 0.5f;
    return ((a + c) + (b * share + d * (1.0f - share))) * (1.0f / 3.0f);
}

// Sample `part` of a quad: the centroid of one of samples^2 parts of equal area. The area of the
// bilinear map's cells is linear in s and t, so rows and then cells end at quantiles of it.
static float3 quad_sample(const float3* corner, int part, int samples) {
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
    return quad_centroid(quad_point(corner, s0, t0), quad_point(corner, s1, t0),
                         quad_point(corner, s1, t1), quad_point(corner, s0, t1));
}

static void store_axis(float3 axis, __global float* to) {
    to[0] = axis.x;
    to[1] = axis.y;
    to[2] = axis.z;
}

__kernel void aim_hemisphere(__global Shot* shot, const __global float* corners,
                             const __global float* normals, int stride,
                             const __global int* patch_samples) {
    if (shot->status != kRunning) return;
    const int patch = shot->patch, samples = patch_samples[patch], part = shot->part;
    ++shot->part;
    shot->part_count = samples * samples;
    float3 corner[4];
    for (int k = 0; k < 4; ++k)
        corner[k] = corner_of(corners, stride, patch, min(k, CORNERS - 1));
    const bool triangle = all(corner[3] == corner[2]);
    store_axis(triangle ? triangle_sample(corner[0], corner[1], corner[2], part, samples)
                        : quad_sample(corner, part, samples),
               shot->origin);

    const float3 normal =
        (float3)(normals[patch], normals[stride + patch], normals[2 * stride + patch]);
    const float3 edge = corner[1] - corner[0];
    const float3 along = normalize(edge - normal * dot(edge, normal));
    const float angle = disk_angle(patch, part);
    const float3 u_axis = cos(angle) * along + sin(angle) * cross(normal, along);
    store_axis(u_axis, shot->u_axis);
    store_axis(cross(normal, u_axis), shot->v_axis);
    store_axis(normal, shot->normal);
}
