#include <gtest/gtest.h>

#include "reference/projector.h"
#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test {
namespace {

constexpr std::uint32_t kResolution = 64;

using Plane = std::array<float, 3>;

// The moment of the line p -> q per unit length, about the hemisphere's centre, over the distance
// of its nearer end and what the grid adds.
Plane edge_plane(Scalar3 p, Scalar3 q) {
    const auto d = scalar_difference(q, p);
    const float squared = scalar_dot(d, d);
    if (squared == 0) return {0, 0, 1};  // all that is above the horizon is inside
    const float scale = 1.0f / std::sqrt(squared);
    const auto moment = scalar_cross(d, scalar_dot(q, q) < scalar_dot(p, p) ? q : p);
    const float reach =
        std::sqrt(std::min(scalar_dot(p, p), scalar_dot(q, q))) + kGridMargin / kEdgeMargin;
    const float over = 1.0f / reach;
    return {over * (scale * moment.x), over * (scale * moment.y), over * (scale * moment.z)};
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

// Stacks that hold, of a PE's patches, those that are in front and face the shooter.
struct LoadedStacks {
    std::vector<std::int32_t> slots, heights;
    std::vector<std::size_t> patches;  // all of them, in their order
};

LoadedStacks visible_stacks(const device::Shot& shot, const PatchArrays& arrays,
                            const Stacks& stacks) {
    LoadedStacks loaded{std::vector<std::int32_t>(stacks.slots(), -1),
                        std::vector<std::int32_t>(stacks.count(), 0),
                        {}};
    for (std::size_t patch = 0; patch < arrays.patch_count; ++patch) {
        const auto first = relative_to(shot, corner_of(arrays, patch, 0));
        float highest = -1;
        for (std::size_t k = 0; k < arrays.corner_count; ++k)
            highest = std::max(
                highest, scalar_dot(shot.normal, relative_to(shot, corner_of(arrays, patch, k))));
        if (scalar_dot(normal_of(arrays, patch), first) > -1e-3f || highest < 1e-3f) continue;
        auto& height = loaded.heights[patch / stacks.depth];
        loaded.slots[patch / stacks.depth * stacks.depth + height++] =
            static_cast<std::int32_t>(patch);
        loaded.patches.push_back(patch);
    }
    return loaded;
}

std::vector<device::Projection> projections_of(const device::Shot& shot, const PatchArrays& arrays,
                                               const Shape& shape) {
    const Stacks stacks(shape, arrays.stride);
    const auto loaded = visible_stacks(shot, arrays, stacks);
    KernelOptions options;
    options.lanes = shape.lanes;
    options.corners = arrays.corner_count;
    options.resolution = kResolution;
    KernelRun run("set_up_projection", options);
    auto projections = run.plural(std::vector<device::Projection>(stacks.slots()));
    run.issue(stacks.grid, run.plural(std::vector{shot}), run.plural(arrays.corners),
              run.plural(arrays.normals), std::int32_t(arrays.stride), std::int32_t(stacks.depth),
              run.plural(loaded.slots), run.plural(loaded.heights), projections);

    const auto slots = run.acu().unload(projections);
    std::vector<device::Projection> result;
    for (std::size_t pe = 0; pe < stacks.count(); ++pe)
        for (int level = 0; level < loaded.heights[pe]; ++level)
            result.push_back(slots[pe * stacks.depth + level]);
    return result;
}

std::vector<std::size_t> visible_patches(const device::Shot& shot, const PatchArrays& arrays) {
    return visible_stacks(shot, arrays, Stacks(shapes().front(), arrays.stride)).patches;
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
        const auto patches = visible_patches(shot_, arrays);

        const auto projections = projections_of(shot_, arrays, GetParam());

        ASSERT_EQ(projections.size(), patches.size());
        for (std::size_t i = 0; i < patches.size(); ++i) {
            EXPECT_EQ(projections[i].patch, static_cast<std::int32_t>(patches[i]));
            const auto edges = expected_edges(shot_, arrays, patches[i]);
            for (std::size_t k = 0; k < edges.size(); ++k)
                ASSERT_EQ(std::to_array(projections[i].edge[k]), edges[k]) << "patch " << i;
            ASSERT_EQ(std::to_array(projections[i].depth),
                      expected_depth(shot_, arrays, patches[i]))
                << "patch " << i;
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

// Of the projection that the first shape made: rectangles do not depend on lanes or stacks.
TEST_P(SetUpProjection, BoundingRectanglesAreThoseOfTheFirstShape) {
    const auto arrays = random_patches(1000, 4, 22);
    const auto first = projections_of(shot_, arrays, shapes().front());

    const auto projections = projections_of(shot_, arrays, GetParam());

    ASSERT_EQ(projections.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
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
    ASSERT_FALSE(visible_patches(shot, arrays).empty());
    shot.status = kConverged;

    for (const auto& projection : projections_of(shot, arrays, shapes().front()))
        EXPECT_EQ(projection.columns, 0u);
}

}  // namespace
}  // namespace hemirad::test
