// Sec. 1.5.2: projection parameters. Each PE prepares the visible patches of its stack: shooter's
// frame, elliptic arcs (eq. 1.2), depth plane (app. A), bounding rectangle (app. B). Those whose
// rectangle holds no proxel's centre are left out.
#include "clip.clh"
#include "patches.clh"
#include "progress.clh"
#include "stacks.clh"

// How far the shooter lies in front of a patch's plane, by the corner that errs least. cull_patches
// has shown it to be more than kGridMargin.
static real_v height_over(Point normal, const Point* corner) {
    real_v height = -dot_v(normal, corner[0]), nearest = dot_v(corner[0], corner[0]);
    for (int k = 1; k < CORNERS; ++k) {
        const real_v squared = dot_v(corner[k], corner[k]);
        const int_v nearer = less_v(squared, nearest);
        nearest = choose_v(nearer, squared, nearest);
        height = choose_v(nearer, -dot_v(normal, corner[k]), height);
    }
    return fmax(height, (real_v)kGridMargin);
}

// -1/rho of app. A as a plane: the nearest patch has the smallest value.
static Point depth_plane(const __global Shot* shot, Point normal, real_v height) {
    return scaled_v(1.0f / height, rotated_into(shot, normal));
}

// Spencer's approximation (app. A): -1/rho of one point, for all proxels of a patch.
static Point constant_depth(Point centre) {
    const Point result = {-1.0f / sqrt(dot_v(centre, centre)), (real_v)0.0f, (real_v)0.0f};
    return result;
}

static Point unit_direction(Point corner, real_v distance) {
    const real_v safe = choose_v(less_v((real_v)0.0f, distance), distance, (real_v)1.0f);
    return scaled_v(1.0f / safe, corner);
}

typedef struct {
    Point planes[CORNERS], depth;
    int_v columns, rows;
} Projections;

// Of LANES patches, by their corners in the shooter's frame.
static void set_up_outline(const Point* corner, Projections* of) {
    Point direction[CORNERS];
    real_v distance[CORNERS];
    for (int k = 0; k < CORNERS; ++k) {
        distance[k] = sqrt(dot_v(corner[k], corner[k]));
        direction[k] = unit_direction(corner[k], distance[k]);
    }
    real_v squared = MAXFLOAT, farthest = 0.0f;
    for (int k = 0; k < CORNERS; ++k) {
        const int next = (k + 1) % CORNERS;
        const real_v reach = edge_reach(distance[k], distance[next]);
        of->planes[k] = edge_plane(corner[k], corner[next], reach);
        squared = least_squared(corner[k], corner[next], of->planes[k], reach, squared);
        farthest = max(farthest, reach);
    }
    const Bounds bounds = clipped_bounds(corner, direction, of->planes);
    const real_v play = play_of(farthest, squared);
    of->columns = proxel_range(bounds.u_least, bounds.u_most, play);
    of->rows = proxel_range(bounds.v_least, bounds.v_most, play);
}

// The words of LANES records, one vector a word, in the order of Projection.
static void words_of(const Projections* from, int patch, real_v* word) {
    for (int k = 0; k < 4; ++k) {
        const Point plane = from->planes[k < CORNERS ? k : 0];
        word[3 * k] = plane.x;
        word[3 * k + 1] = plane.y;
        word[3 * k + 2] = plane.z;
    }
    word[12] = from->depth.x;
    word[13] = from->depth.y;
    word[14] = from->depth.z;
    word[15] = as_real_v(patch + LANE_INDEX);
}

// Appends those of LANES projections that are kept; returns how many. What is written of the others
// is written over: the PE has room for one of each of its patches.
static int store_projections(const Projections* from, int patch, int kept,
                             __global Projection* projections, __global Rectangle* rectangles) {
    real_v word[16];
    float16 record[LANES];
    words_of(from, patch, word);
    turn_words(word, record);
    int count = 0;
    UNROLLED for (int lane = 0; lane < LANES; ++lane) {
        const Rectangle rectangle = {int_lane_of(from->columns, lane),
                                     int_lane_of(from->rows, lane)};
        ((__global float16*)projections)[count] = record[lane];
        rectangles[count] = rectangle;
        count += kept >> lane & 1;
    }
    return count;
}

// Whether a proxel lies inside all arcs, by the operations of project_patches.
static int_v claims(const Projections* of, int_v column, int_v row) {
    const int_v a = centre_numerator(column), b = centre_numerator(row);
    const real_v u = to_real_v(a) * (1.0f / RESOLUTION), v = to_real_v(b) * (1.0f / RESOLUTION);
    const real_v root = root_at(a, b);
    int_v least = INT_MAX;
    for (int k = 0; k < CORNERS; ++k) {
        const Point plane = of->planes[k];
        const real_v linear = fma(plane.y, v, fma(plane.x, u, (real_v)kEdgeMargin));
        least = min(least, as_int_v(fma(plane.z, root, linear)));
    }
    return at_least_v(least, (int_v)0) & less_v((real_v)0.0f, root);
}

// Whether the patch may own a proxel: its rectangle has some (the empty range is 1) and, where they
// are no more than 2 x 2, one lies inside the outline. In a scene of a million patches, four of five
// that the shooter might see lie between the proxels. The paper's machine projects them; so it is
// where its areas are counted, and where further areas have other bits than these.
static int_v has_proxels(const Projections* of) {
    const int_v some = ~equal_v(of->columns, (int_v)1) & ~equal_v(of->rows, (int_v)1);
#if defined(EVALUATE_INCREMENTAL) || defined(COUNT_ACTIVITY)
    return some;
#else
    const int_v left = of->columns & 0xffff, right = of->columns >> 16;
    const int_v top = of->rows & 0xffff, bottom = of->rows >> 16;
    const int_v few = at_least_v((int_v)1, right - left) & at_least_v((int_v)1, bottom - top);
    if (!any_v(some & few)) return some;
    return some & (~few | claims(of, left, top) | claims(of, right, top) |
                   claims(of, left, bottom) | claims(of, right, bottom));
#endif
}

__kernel void set_up_projection(const __global Shot* salvo, const __global int* corners,
                                const __global float* normals, int stride, int depth,
                                const __global Level* stack, const __global int* stack_height,
                                __global Projection* projections,
                                __global Rectangle* rectangles, __global int* projection_count) {
    const Stack own = own_stack(salvo);
    if (own.member < 0) return;
    const __global Shot* shot = salvo + own.member;
    const __global Level* level = stack + own.place * (depth / LANES);
    const __global Level* end = level + stack_height[own.place];
    int count = 0;
    for (; level < end; ++level) {
        const int patch = level->patch;
        const int slot = own.place * depth + count;
        fetch_patches_ahead(corners, normals, stride, level + 1, end);
        UNROLLED for (int k = 0; k < LANES; ++k) own_ahead(projections + slot + k);
        Point corner[CORNERS];
        relative_corners(shot, corners, stride, patch, corner);
        const Point normal = consecutive_points(normals, stride, patch);
        const real_v height = height_over(normal, corner);
        turn_corners(shot, corner);
        Projections of;
        set_up_outline(corner, &of);
        const int kept = level->visible & bits_of(has_proxels(&of));
        if (kept == 0) continue;
#ifdef DISTANCE_CONSTANT
        Point centre = corner[0];
        for (int k = 1; k < CORNERS; ++k) centre = sum_v(centre, corner[k]);
        of.depth = constant_depth(scaled_v((real_v)(1.0f / CORNERS), centre));
#else
        of.depth = depth_plane(shot, normal, height);
#endif
        count += store_projections(&of, patch, kept, projections + slot, rectangles + slot);
    }
    projection_count[own.place] = count;
}
