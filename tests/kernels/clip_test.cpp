#include <gtest/gtest.h>

#include <random>

#include "kernels/shared.h"
#include "support/exact_bounds.h"
#include "support/patch_database.h"

namespace hemirad::test::clip_test {
namespace {

constexpr std::size_t kPatches = 40000;  // a multiple of sixteen
constexpr std::uint32_t kResolution = 1024;

using Corners = std::vector<Float3>;  // of one patch, in the shooter's frame

// How many corners lie below the horizon decides which way a patch is clipped.
struct Patches {
    std::vector<Corners> corners;
    std::array<int, 5> below_count{};
};

double least_distance(const Corners& corners) {
    std::vector<glm::dvec3> points;
    for (const auto& corner : corners) points.push_back(exact(corner));
    return exact_bounds(points).distance;
}

Patches random_patches_across_the_horizon(int corner_count, unsigned seed,
                                          double least_distance_kept = 1e-2) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> across(-1, 1), size(0.01, 1.5);
    Patches patches;
    while (patches.corners.size() < kPatches) {
        const glm::dvec3 centre(2 * across(random), 2 * across(random), 0.6 * across(random));
        const auto polygon = random_polygon(random, centre, size(random), corner_count);
        Corners corners;
        for (int k = 0; k < corner_count; ++k) corners.push_back(rounded(polygon.corners[k]));
        const auto below = std::count_if(corners.begin(), corners.end(),
                                         [](const Float3& corner) { return corner[2] < 0; });
        if (below == corner_count || least_distance(corners) < least_distance_kept) continue;
        ++patches.below_count[below];
        patches.corners.push_back(corners);
    }
    return patches;
}

DeviceBounds bounds_of(const std::vector<Corners>& patches, std::uint32_t lanes) {
    const std::size_t count = patches.size(), corner_count = patches.front().size();
    std::vector<float> corners;
    for (std::size_t k = 0; k < corner_count; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const auto& patch : patches) corners.push_back(patch[k][axis]);
    auto run = KernelRun::probe(
        "bounds", "bound_patches",
        probe_options(lanes, static_cast<std::uint32_t>(corner_count), kResolution));
    auto values = run.acu().plural<float>(4 * count);
    auto ranges = run.acu().plural<std::uint32_t>(2 * count);
    run.issue(probe_grid(count, lanes), run.plural(corners), std::int32_t(count), values, ranges);
    return {run.acu().unload(values), run.acu().unload(ranges)};
}

class Clip : public testing::TestWithParam<int> {};  // corners

INSTANTIATE_TEST_SUITE_P(Corners, Clip, testing::Values(3, 4));

TEST_P(Clip, BoundsHoldThePartAboveTheHorizonAndAreTightToOneProxel) {
    const auto patches = random_patches_across_the_horizon(GetParam(), 110);
    for (int below = 0; below < GetParam(); ++below) ASSERT_GT(patches.below_count[below], 100);

    const auto bounds = bounds_of(patches.corners, 16);

    for (std::size_t i = 0; i < kPatches; ++i) {
        std::vector<glm::dvec3> corners;
        for (const auto& corner : patches.corners[i]) corners.push_back(exact(corner));
        const auto expected = exact_bounds(corners);
        for (const auto& [range, interval] : {std::pair(bounds.ranges[i], expected.u),
                                              std::pair(bounds.ranges[kPatches + i], expected.v)}) {
            const auto beyond = excess(range, interval, kResolution);
            ASSERT_GE(std::min(beyond.before, beyond.after), 0) << "patch " << i;
            ASSERT_LE(std::max(beyond.before, beyond.after), 1) << "patch " << i;
        }
    }
}

TEST_P(Clip, BoundsAreNeverTooSmallWhereAnEdgeAlmostMeetsTheShooter) {
    const auto patches = random_patches_across_the_horizon(GetParam(), 112, 1e-5);

    const auto bounds = bounds_of(patches.corners, 16);

    for (std::size_t i = 0; i < kPatches; ++i) {
        std::vector<glm::dvec3> corners;
        for (const auto& corner : patches.corners[i]) corners.push_back(exact(corner));
        const auto expected = exact_bounds(corners);
        for (const auto& [range, interval] : {std::pair(bounds.ranges[i], expected.u),
                                              std::pair(bounds.ranges[kPatches + i], expected.v)}) {
            const auto beyond = excess(range, interval, kResolution);
            ASSERT_GE(std::min(beyond.before, beyond.after), 0)
                << "patch " << i << " at " << expected.distance;
        }
    }
}

// Triangles of which an edge passes the shooter at 1e-5 to 1e-1.
std::vector<Corners> triangles_beside_the_shooter(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> across(-1, 1), exponent(-5, -1), length(0, 2);
    const auto point = [&] { return glm::dvec3(across(random), across(random), across(random)); };
    std::vector<Corners> triangles;
    while (triangles.size() < kPatches) {
        const auto along = glm::normalize(point());
        const auto foot =
            std::pow(10.0, exponent(random)) * glm::normalize(glm::cross(along, point()));
        const Corners corners = {rounded(foot + length(random) * along),
                                 rounded(foot - length(random) * along), rounded(1.5 * point())};
        const bool below = std::all_of(corners.begin(), corners.end(),
                                       [](const Float3& corner) { return corner[2] < 0; });
        if (!below && least_distance(corners) > 1e-5) triangles.push_back(corners);
    }
    return triangles;
}

TEST(ClipBesideTheShooter, BoundsAreNeverTooSmall) {
    const auto triangles = triangles_beside_the_shooter(5);

    const auto bounds = bounds_of(triangles, 16);

    for (std::size_t i = 0; i < kPatches; ++i) {
        std::vector<glm::dvec3> corners;
        for (const auto& corner : triangles[i]) corners.push_back(exact(corner));
        const auto expected = exact_bounds(corners);
        for (const auto& [range, interval] : {std::pair(bounds.ranges[i], expected.u),
                                              std::pair(bounds.ranges[kPatches + i], expected.v)}) {
            const auto beyond = excess(range, interval, kResolution);
            ASSERT_GE(std::min(beyond.before, beyond.after), 0) << "triangle " << i;
        }
    }
}

TEST_P(Clip, BoundsDoNotDependOnTheLanes) {
    const auto patches = random_patches_across_the_horizon(GetParam(), 111).corners;
    const auto wide = bounds_of(patches, 16);

    for (const std::uint32_t lanes : {1u, 4u, 8u}) {
        const auto narrow = bounds_of(patches, lanes);

        EXPECT_EQ(bits(narrow.values), bits(wide.values)) << lanes << " lanes";
        EXPECT_EQ(narrow.ranges, wide.ranges) << lanes << " lanes";
    }
}

// Both below corners beside each other, far behind the shooter: the outline leaves through one
// side and enters through the other, and between them the disk's rim bulges beyond both.
TEST(ClipAcrossTheAxis, TheRimBetweenTheCrossingsIsIncluded) {
    const Corners wall = {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}};

    const auto bounds = bounds_of(std::vector<Corners>(16, wall), 16);

    EXPECT_EQ(bounds.values[16], 1.0f);  // most u, of the first
}

}  // namespace
}  // namespace hemirad::test::clip_test
