#include "solver/find_shooter_splits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "solver/support.h"

namespace hemirad::test::find_shooter_splits_test {
namespace {

/// A floor of 4 m x 2 m in patches of 1 m, numbered along x, then y, in elements of 0.5 m; and
/// beyond y = 2 a wall of 4 m x 2 m, in patches of 1 m too, at a distance.
Mesh floor_and_wall(double distance, double scale = 1) {
    const double y = 2 + distance;
    Scene scene = scene_of({rectangle(0, 0, 4, 2), {{0, y, 0}, {4, y, 0}, {4, y, 2}, {0, y, 2}}});
    for (auto& position : scene.positions) position *= scale;
    return build_mesh(scene, {.patch_size = scale,
                              .element_size = 0.5 * scale,
                              .split_levels = 1,
                              .backfaces = Backfaces::cull});
}

using Light = std::function<double(const glm::dvec3& at)>;

/// An irradiance of 1 everywhere, in each band; radiosities as said.
Solution solution_with(const Mesh& mesh, const std::vector<Light>& radiosities) {
    Solution solution;
    for (const Light& light : radiosities) {
        solution.irradiance.emplace_back(mesh.patches.size(), 1.0);
        solution.radiosity.emplace_back();
        for (const Patch& patch : mesh.patches)
            solution.radiosity.back().push_back(light(mesh.centroid(patch)));
    }
    return solution;
}

std::vector<std::size_t> splits(const Mesh& mesh, const std::vector<Light>& radiosities,
                                double bound) {
    const auto split = find_shooter_splits(mesh, solution_with(mesh, radiosities), bound);
    EXPECT_EQ(split.size(), mesh.shooters.size());
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < split.size(); ++i)
        if (split[i]) found.push_back(i);
    return found;
}

using Indices = std::vector<std::size_t>;

const Light kLitBeyondHalfAPatch = [](const glm::dvec3& at) {
    return at.z == 0 && at.x < 1.5 ? 0.0 : 1.0;
};

TEST(FindShooterSplits, FindsTheHalfLitOneBesideAWall) {
    EXPECT_EQ(splits(floor_and_wall(0), {kLitBeyondHalfAPatch}, 0.02), (Indices{5}));
}

TEST(FindShooterSplits, FindsNoneThatNothingStandsNear) {
    EXPECT_EQ(splits(floor_and_wall(20), {kLitBeyondHalfAPatch}, 0.001), Indices{});
}

TEST(FindShooterSplits, FindsNoneWhereElementsAreEquallyBright) {
    const auto by_patch = [](const glm::dvec3& at) { return std::floor(at.x); };

    EXPECT_EQ(splits(floor_and_wall(0), {by_patch}, 1e-9), Indices{});
}

TEST(FindShooterSplits, FindsWhatOneBandShows) {
    const auto even = [](const glm::dvec3&) { return 1.0; };

    EXPECT_EQ(splits(floor_and_wall(0), {even, kLitBeyondHalfAPatch, even}, 0.02), (Indices{5}));
}

TEST(FindShooterSplits, FindsTheSameInASceneOfAnySize) {
    for (const double scale : {1e-3, 1e3}) {
        const auto half_lit = [&](const glm::dvec3& at) {
            return kLitBeyondHalfAPatch(at / scale);
        };

        EXPECT_EQ(splits(floor_and_wall(0, scale), {half_lit}, 0.02), (Indices{5}));
    }
}

TEST(FindShooterSplits, FindsNoneInAFurnace) {
    const Mesh mesh =
        build_mesh(scene_named("furnace.obj"),
                   {.patch_size = 0.5, .element_size = 0.125, .max_reflectance = 0.995});
    auto how = settings(128, 1e-2);
    how.form_factor = FormFactorMode::analytic;

    const auto split = find_shooter_splits(mesh, solution_of(mesh, how), 0.002);

    EXPECT_EQ(split, std::vector<bool>(24, false));
}

}  // namespace
}  // namespace hemirad::test::find_shooter_splits_test
