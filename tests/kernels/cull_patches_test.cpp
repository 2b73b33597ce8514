#include <gtest/gtest.h>

#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test::cull_patches_test {
namespace {

bool is_before(float height, Scalar3 corner) {
    const float sure = height - kGridMargin;
    return sure > 0 && sure * sure > scalar_dot(corner, corner) * (kPlaneMargin * kPlaneMargin);
}

// Sec. 1.5.1: lies not in the shooter's plane, faces it, and is not entirely behind it.
bool potentially_visible(const device::Shot& shot, const PatchArrays& arrays, std::size_t patch) {
    const int own = shot.plane;
    if (own >= 0 && arrays.planes[patch] == own) return false;
    bool facing = false, in_front = false;
    for (std::size_t k = 0; k < arrays.corner_count; ++k) {
        const auto corner = relative_to(shot, corner_of(arrays, patch, k));
        facing |= is_before(-scalar_dot(normal_of(arrays, patch), corner), corner);
        in_front |= is_before(scalar_dot(shot.normal, corner), corner);
    }
    return facing && in_front;
}

using StackContents = std::vector<std::vector<std::int32_t>>;

StackContents expected_stacks(const device::Shot& shot, const PatchArrays& arrays,
                              const Stacks& stacks) {
    StackContents contents(stacks.count());
    for (std::size_t patch = 0; patch < arrays.patch_count; ++patch)
        if (potentially_visible(shot, arrays, patch))
            contents[patch / stacks.depth].push_back(static_cast<std::int32_t>(patch));
    return contents;
}

void push_patches(const device::Level& level, const Shape& shape, std::vector<std::int32_t>& to) {
    EXPECT_NE(level.visible, 0);
    for (std::int32_t lane = 0; lane < std::int32_t(shape.lanes); ++lane)
        if ((level.visible >> lane & 1) != 0) to.push_back(level.patch + lane);
}

StackContents stacks_after(const device::Shot& shot, const PatchArrays& arrays,
                           const Shape& shape) {
    const Stacks stacks(shape, arrays.stride);
    KernelOptions options;
    options.lanes = shape.lanes;
    options.corners = arrays.corner_count;
    KernelRun run("cull_patches", options);
    auto stack = run.plural(std::vector<device::Level>(stacks.slots() / shape.lanes));
    auto heights = run.plural(std::vector<std::int32_t>(stacks.count(), -1));
    run.issue(run.fitting(stacks.grid), run.plural(std::vector{shot}),
              run.plural(clusters_of(arrays)), run.plural(arrays.corners),
              run.plural(arrays.normals), run.plural(arrays.planes), run.plural(arrays.rooms),
              std::int32_t(arrays.stride), std::int32_t(stacks.depth), stack, heights);

    const auto levels = run.acu().unload(stack);
    const auto height = run.acu().unload(heights);
    StackContents contents(stacks.count());
    for (std::size_t pe = 0; pe < stacks.count(); ++pe)
        for (int level = 0; level < height[pe]; ++level)
            push_patches(levels[pe * (stacks.depth / shape.lanes) + level], shape, contents[pe]);
    return contents;
}

class CullPatches : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, CullPatches, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(CullPatches, VisiblePatchesLieOnTopOfTheStackInTheirOrder) {
    const auto shot = shot_from({0.1, -0.2, 0.05}, {0.3, 0.4, 0.8});
    for (const int corners : {3, 4}) {
        const auto arrays = random_patches(1000, corners, 10);

        const auto stacks = stacks_after(shot, arrays, GetParam());

        EXPECT_EQ(stacks, expected_stacks(shot, arrays, Stacks(GetParam(), arrays.stride)));
    }
}

constexpr double kStep = 0.05;

// Walls of a grid, every second one a step before the last: most clusters lie in one plane, some
// reach over two, parallel or not.
PatchArrays gridded_walls(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> inside(-0.9, 0.9);
    std::vector<Polygon> patches;
    glm::dvec3 corner{}, u{}, v{};
    for (int wall = 0; wall < 12; ++wall) {
        if (wall % 2 == 0) {
            corner = {inside(random), inside(random), inside(random)};
            u = glm::normalize(glm::dvec3(inside(random), inside(random), inside(random)));
            v = glm::normalize(glm::cross(u, glm::dvec3(inside(random), 1, 0.3)));
        } else {
            corner += kStep * glm::cross(u, v);
        }
        for (int i = 0; i < 15; ++i)
            for (int k = 0; k < 15; ++k)
                patches.push_back(
                    square(corner + 0.05 * (double(i) * u + double(k) * v), u, v, 0.05));
    }
    return patch_arrays(mesh_of(patches));
}

TEST_P(CullPatches, WhatIsSaidOfClustersHoldsForTheirPatches) {
    const auto arrays = gridded_walls(12);
    std::mt19937 random(13);
    std::uniform_real_distribution<double> any(-0.8, 0.8);
    for (int i = 0; i < 20; ++i) {
        auto shot = shot_from({any(random), any(random), any(random)},
                              {any(random), any(random), any(random)});
        if (i % 2 == 0) {  // from a patch along its normal, or to it from between two walls
            const std::size_t patch = static_cast<std::size_t>(i) * arrays.patch_count / 20;
            const auto normal = normal_of(arrays, patch);
            const glm::dvec3 n(normal.x, normal.y, normal.z);
            const auto middle =
                0.5 * (exact(corner_of(arrays, patch, 0)) + exact(corner_of(arrays, patch, 2)));
            const double between = 0.4 * kStep * arrays.scale;
            shot = i % 4 == 0 ? shot_from(middle + between * n, -n) : shot_from(middle, n);
        }

        const auto stacks = stacks_after(shot, arrays, GetParam());

        ASSERT_EQ(stacks, expected_stacks(shot, arrays, Stacks(GetParam(), arrays.stride)))
            << "shot " << i;
    }
}

TEST_P(CullPatches, OnlyWhatFacesTheShooterFromInFrontOfItIsKept) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    const auto arrays = patch_arrays(mesh_of({
        square({0, 0, 0}, x, y, 1),     // the shooter's own plane
        square({0, 0, 1}, y, x, 1),     // above, faces down
        square({0, 0, 1}, x, y, 1),     // above, faces up
        square({0, 0, -1}, x, y, 1),    // below, faces up
        square({0.7, 0, 0}, z, y, 1),   // beside, half above, faces away
        square({0.7, 0, 0}, y, z, 1),   // beside, half above, faces back, outwards from x
        square({-0.7, 0, 0}, y, z, 1),  // on the other side, half above, faces the shooter
        square({3, 0, 0}, y, x, 1),     // in the shooter's plane, upside down
    }));
    const auto shot = shot_from((glm::dvec3(0) - arrays.centre) * arrays.scale, z);

    const auto stacks = stacks_after(shot, arrays, GetParam());

    std::vector<std::int32_t> kept;
    for (const auto& stack : stacks) kept.insert(kept.end(), stack.begin(), stack.end());
    EXPECT_EQ(kept, (std::vector<std::int32_t>{1, 4, 6}));
}

TEST_P(CullPatches, PatchesOfTheShootersPlaneSeeNothingOfItThoughTheyTilt) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), tilted(0, 0.999, 0.04);
    auto arrays =
        patch_arrays(mesh_of({square({0, 0, 0}, x, y, 1), square({2, 0, 0.1}, tilted, x, 1),
                              square({-2, 0, 0.1}, tilted, x, 1)}));
    arrays.planes = {7, 7, 8};
    arrays.planes.resize(arrays.stride, -1);
    auto shot = shot_from((glm::dvec3(0) - arrays.centre) * arrays.scale, {0, 0, 1});
    shot.plane = 7;

    const auto stacks = stacks_after(shot, arrays, GetParam());

    std::vector<std::int32_t> kept;
    for (const auto& stack : stacks) kept.insert(kept.end(), stack.begin(), stack.end());
    EXPECT_EQ(kept, std::vector<std::int32_t>{2});
}

TEST_P(CullPatches, RoomsThatNoLightComesToAreNotLookedInto) {
    const auto shot = shot_from({0.1, -0.2, 0.05}, {0.3, 0.4, 0.8});
    auto arrays = random_patches(200, 4, 14);
    for (std::uint32_t patch = 0; patch < arrays.patch_count; ++patch)
        arrays.rooms[patch] = std::int32_t(1u << (patch % 3 == 0 ? 31 : patch % 3));
    const Stacks stacks(GetParam(), arrays.stride);
    auto expected = expected_stacks(shot, arrays, stacks);
    for (auto& stack : expected) std::erase_if(stack, [](int patch) { return patch % 3 == 1; });
    auto shut = shot;
    shut.reached = std::int32_t(1u << 31 | 1u << 2);

    EXPECT_EQ(stacks_after(shut, arrays, GetParam()), expected);
    EXPECT_EQ(stacks_after(shot, arrays, GetParam()), expected_stacks(shot, arrays, stacks));
}

TEST_P(CullPatches, AHaltedShotLeavesTheStacksAlone) {
    const auto arrays = random_patches(100, 4, 11);
    auto shot = shot_from({0, 0, 0}, {0, 0, 1});
    shot.status = kConverged;

    const auto stacks = stacks_after(shot, arrays, GetParam());

    EXPECT_EQ(stacks, StackContents(stacks.size()));
}

}  // namespace
}  // namespace hemirad::test::cull_patches_test
