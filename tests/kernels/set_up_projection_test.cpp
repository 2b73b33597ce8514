#include <gtest/gtest.h>

#include "reference/projector.h"
#include "support/exact_bounds.h"
#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test::set_up_projection_test {
namespace {

constexpr std::uint32_t kResolution = 64;

using Plane = std::array<float, 3>;

// The moment of the line p -> q per unit length, about the hemisphere's centre, over the distance
// of its nearer end and what the grid adds.
Plane edge_plane(Scalar3 p, Scalar3 q) {
    const auto d = scalar_difference(q, p);
    const float squared = scalar_dot(d, d);
    if (squared == 0) return {0, 0, 1};  // all that is above the horizon is inside
    const auto moment = scalar_cross(d, scalar_dot(q, q) < scalar_dot(p, p) ? q : p);
    const float reach =
        std::sqrt(std::min(scalar_dot(p, p), scalar_dot(q, q))) + kGridMargin / kEdgeMargin;
    const float scale = 1.0f / (std::sqrt(squared) * reach);
    return {scale * moment.x, scale * moment.y, scale * moment.z};
}

std::vector<Plane> expected_edges(const device::Shot& shot, const PatchArrays& arrays,
                                  std::size_t patch) {
    std::vector<Plane> planes;
    const auto corner = [&](std::size_t k) {
        return rotated_into(shot,
                            relative_to(shot, corner_of(arrays, patch, k % arrays.corner_count)));
    };
    for (std::size_t k = 0; k < arrays.corner_count; ++k)
        planes.push_back(edge_plane(corner(k), corner(k + 1)));
    return planes;
}

// -1/rho of app. A: the patch's normal in the shooter's frame over its plane's distance.
Plane expected_depth(const device::Shot& shot, const PatchArrays& arrays, std::size_t patch) {
    const auto normal = normal_of(arrays, patch);
    auto nearest = relative_to(shot, corner_of(arrays, patch, 0));
    for (std::size_t k = 1; k < arrays.corner_count; ++k) {
        const auto corner = relative_to(shot, corner_of(arrays, patch, k));
        if (scalar_dot(corner, corner) < scalar_dot(nearest, nearest)) nearest = corner;
    }
    const float scale = 1.0f / std::max(-scalar_dot(normal, nearest), kGridMargin);
    const auto turned = rotated_into(shot, normal);
    return {scale * turned.x, scale * turned.y, scale * turned.z};
}

bool is_visible(const device::Shot& shot, const PatchArrays& arrays, std::size_t patch) {
    const auto first = relative_to(shot, corner_of(arrays, patch, 0));
    float highest = -1;
    for (std::size_t k = 0; k < arrays.corner_count; ++k)
        highest = std::max(highest,
                           scalar_dot(shot.normal, relative_to(shot, corner_of(arrays, patch, k))));
    return scalar_dot(normal_of(arrays, patch), first) <= -1e-3f && highest >= 1e-3f;
}

// Stacks that hold, of a PE's patches, those that are in front and face the shooter.
struct LoadedStacks {
    std::vector<device::Level> levels;
    std::vector<std::int32_t> heights;
};

LoadedStacks visible_stacks(const device::Shot& shot, const PatchArrays& arrays,
                            const Stacks& stacks, std::uint32_t lanes) {
    LoadedStacks loaded{std::vector<device::Level>(stacks.slots() / lanes),
                        std::vector<std::int32_t>(stacks.count(), 0)};
    for (std::size_t first = 0; first < arrays.patch_count; first += lanes) {
        device::Level level{static_cast<std::int32_t>(first), 0};
        for (std::size_t lane = 0; lane < lanes && first + lane < arrays.patch_count; ++lane)
            if (is_visible(shot, arrays, first + lane)) level.visible |= 1 << lane;
        auto& height = loaded.heights[first / stacks.depth];
        if (level.visible != 0)
            loaded.levels[first / stacks.depth * (stacks.depth / lanes) + height++] = level;
    }
    return loaded;
}

struct Projected : device::Projection, device::Rectangle {};

std::vector<Projected> projections_of(const device::Shot& shot, const PatchArrays& arrays,
                                      const Shape& shape) {
    const Stacks stacks(shape, arrays.stride);
    const auto loaded = visible_stacks(shot, arrays, stacks, shape.lanes);
    KernelOptions options;
    options.lanes = shape.lanes;
    options.corners = arrays.corner_count;
    options.resolution = kResolution;
    KernelRun run("set_up_projection", options);
    auto projections = run.plural(std::vector<device::Projection>(stacks.slots()));
    auto rectangles = run.plural(std::vector<device::Rectangle>(stacks.slots()));
    auto counts = run.plural(std::vector<std::int32_t>(stacks.count()));
    run.issue(run.fitting(stacks.grid), run.plural(std::vector{shot}), run.plural(arrays.corners),
              run.plural(arrays.normals), std::int32_t(arrays.stride), std::int32_t(stacks.depth),
              run.plural(loaded.levels), run.plural(loaded.heights), projections, rectangles,
              counts);

    const auto slots = run.acu().unload(projections);
    const auto bounds = run.acu().unload(rectangles);
    const auto count = run.acu().unload(counts);
    std::vector<Projected> result;
    for (std::size_t pe = 0; pe < stacks.count(); ++pe)
        for (int slot = 0; slot < count[pe]; ++slot)
            result.push_back({slots[pe * stacks.depth + slot], bounds[pe * stacks.depth + slot]});
    return result;
}

std::vector<glm::dvec3> frame_corners(const device::Shot& shot, const PatchArrays& arrays,
                                      std::size_t patch) {
    std::vector<glm::dvec3> corners;
    for (std::size_t k = 0; k < arrays.corner_count; ++k) {
        const auto corner = rotated_into(shot, relative_to(shot, corner_of(arrays, patch, k)));
        corners.emplace_back(corner.x, corner.y, corner.z);
    }
    return corners;
}

bool lies_between_proxels(const Interval& interval) {
    const double half = 0.5 * kResolution, centre = half - 0.5;
    return std::ceil(interval.least * half + centre) > std::floor(interval.most * half + centre);
}

bool claims_a_proxel(const std::vector<Plane>& edges) {
    for (int row = 0; row < int(kResolution); ++row)
        for (int column = 0; column < int(kResolution); ++column) {
            if (!reference::in_disk(column, row, kResolution)) continue;
            const double u = (2.0 * column + 1 - kResolution) / kResolution;
            const double v = (2.0 * row + 1 - kResolution) / kResolution;
            const double w = std::sqrt(1 - u * u - v * v);
            if (std::all_of(edges.begin(), edges.end(), [&](const Plane& edge) {
                    return edge[0] * u + edge[1] * v + edge[2] * w >= 0;
                }))
                return true;
        }
    return false;
}

bool holds_a_proxel(const device::Rectangle& rectangle) {
    return (rectangle.columns & 0xffff) <= rectangle.columns >> 16 &&
           (rectangle.rows & 0xffff) <= rectangle.rows >> 16;
}

class SetUpProjection : public testing::TestWithParam<Shape> {
  protected:
    device::Shot shot_ = shot_from({0.1, -0.2, 0.05}, {0.3, 0.4, 0.8});
};

INSTANTIATE_TEST_SUITE_P(Shapes, SetUpProjection, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(SetUpProjection, ArcsAndDepthPlanesHaveTheBitsOfTheScalarComputation) {
    for (const int corners : {3, 4}) {
        const auto arrays = random_patches(1000, corners, 20);

        const auto projections = projections_of(shot_, arrays, GetParam());

        std::size_t visible = 0;
        for (std::size_t patch = 0; patch < arrays.patch_count; ++patch)
            visible += is_visible(shot_, arrays, patch);
        ASSERT_GT(projections.size(), visible / 2);  // some are smaller than a proxel
        for (const auto& projection : projections) {
            const auto patch = static_cast<std::size_t>(projection.patch);
            ASSERT_TRUE(is_visible(shot_, arrays, patch));
            const auto edges = expected_edges(shot_, arrays, patch);
            for (std::size_t k = 0; k < edges.size(); ++k)
                ASSERT_EQ(std::to_array(projection.edge[k]), edges[k]) << "patch " << patch;
            ASSERT_EQ(std::to_array(projection.depth), expected_depth(shot_, arrays, patch))
                << "patch " << patch;
        }
    }
}

TEST_P(SetUpProjection, ARepeatedCornerGivesAnEdgeThatEveryDirectionIsInsideOf) {
    const auto arrays = random_patches(300, 4, 21);  // every third is a triangle

    const auto projections = projections_of(shot_, arrays, GetParam());

    int triangles = 0;
    for (const auto& projection : projections) {
        if (projection.patch % 3 != 0) continue;
        ++triangles;
        EXPECT_EQ(std::to_array(projection.edge[2]), (Plane{0, 0, 1}));
    }
    EXPECT_GT(triangles, 10);
}

// Tiny patches, of which most lie between proxels' centres.
TEST_P(SetUpProjection, PatchesWithoutAProxelAreLeftOutAndOnlyThose) {
    auto arrays = random_patches(1000, 4, 25);
    for (std::size_t patch = 0; patch < arrays.patch_count; ++patch)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t k = 1; k < 4; ++k) {
                const auto at = [&](std::size_t corner) -> std::int32_t& {
                    return arrays.corners[(3 * corner + axis) * arrays.stride + patch];
                };
                at(k) = at(0) + (at(k) - at(0)) / 8;
            }

    const auto projections = projections_of(shot_, arrays, GetParam());

    std::vector<bool> kept(arrays.patch_count);
    for (const auto& projection : projections) {
        EXPECT_TRUE(holds_a_proxel(projection));
        kept[static_cast<std::size_t>(projection.patch)] = true;
    }
    std::size_t left_out = 0;
    std::size_t outlines_beside = 0;
    for (std::size_t patch = 0; patch < arrays.patch_count; ++patch) {
        if (kept[patch] || !is_visible(shot_, arrays, patch)) continue;
        ++left_out;
        const auto bounds = exact_bounds(frame_corners(shot_, arrays, patch));
        if (lies_between_proxels(bounds.u) || lies_between_proxels(bounds.v)) continue;
        ++outlines_beside;
        EXPECT_FALSE(claims_a_proxel(expected_edges(shot_, arrays, patch))) << "patch " << patch;
    }
    EXPECT_GT(outlines_beside, 10u);
    EXPECT_GT(projections.size(), 10u);
    EXPECT_GT(left_out, 100u);
}

// Of the projection that the first shape made: rectangles do not depend on lanes or stacks.
TEST_P(SetUpProjection, BoundingRectanglesAreThoseOfTheFirstShape) {
    const auto arrays = random_patches(1000, 4, 22);
    const auto first = projections_of(shot_, arrays, shapes().front());

    const auto projections = projections_of(shot_, arrays, GetParam());

    ASSERT_EQ(projections.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        EXPECT_EQ(projections[i].patch, first[i].patch);
        EXPECT_EQ(projections[i].columns, first[i].columns) << "patch " << i;
        EXPECT_EQ(projections[i].rows, first[i].rows) << "patch " << i;
    }
}

TEST(SetUpProjectionBounds, HoldEveryProxelThatLiesInsideThePatchInDoublePrecision) {
    const auto shot = shot_from({0.1, -0.2, 0.05}, {0.3, 0.4, 0.8});
    for (const int corners : {3, 4}) {
        const auto arrays = random_patches(1000, corners, 23);
        std::size_t inside_count = 0;

        for (const auto& projection : projections_of(shot, arrays, shapes().front())) {
            const int first_column = projection.columns & 0xffff,
                      last_column = projection.columns >> 16;
            const int first_row = projection.rows & 0xffff, last_row = projection.rows >> 16;
            for (int row = 0; row < int(kResolution); ++row)
                for (int column = 0; column < int(kResolution); ++column) {
                    if (!reference::in_disk(column, row, kResolution)) continue;
                    const double u = (2.0 * column + 1 - kResolution) / kResolution;
                    const double v = (2.0 * row + 1 - kResolution) / kResolution;
                    const double w = std::sqrt(1 - u * u - v * v);
                    bool inside = true;
                    for (int k = 0; k < corners; ++k)
                        inside &= projection.edge[k][0] * u + projection.edge[k][1] * v +
                                      projection.edge[k][2] * w >=
                                  0;
                    if (!inside) continue;
                    ++inside_count;
                    ASSERT_TRUE(first_column <= column && column <= last_column &&
                                first_row <= row && row <= last_row)
                        << "patch " << projection.patch << " proxel " << column << " " << row;
                }
        }
        EXPECT_GT(inside_count, 1000u);
    }
}

TEST(SetUpProjectionOfAHaltedShot, WritesNothing) {
    const auto arrays = random_patches(100, 4, 24);
    auto shot = shot_from({0, 0, 0}, {0, 0, 1});
    ASSERT_FALSE(projections_of(shot, arrays, shapes().front()).empty());
    shot.status = kConverged;

    EXPECT_TRUE(projections_of(shot, arrays, shapes().front()).empty());
}

}  // namespace
}  // namespace hemirad::test::set_up_projection_test
