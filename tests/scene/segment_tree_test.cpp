#include "scene/segment_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace hemirad::test::segment_tree_test {
namespace {

using meshing::Segment;
using meshing::SegmentTree;
using meshing::Slab;

constexpr std::uint32_t kSpokes = 4000, kHub = kSpokes / 2;

/// A wave on a cylinder about a hub, which is somewhere among the other vertices; neighbours are
/// far apart.
std::vector<glm::dvec3> wave() {
    std::vector<glm::dvec3> positions;
    for (std::uint32_t i = 0; i <= kSpokes; ++i)
        positions.push_back({std::cos(i), std::sin(i), std::cos(3 * i)});
    positions[kHub] = {};
    return positions;
}

std::vector<Segment> spokes() {
    std::vector<Segment> spokes;
    for (std::uint32_t i = 0; i <= kSpokes; ++i)
        if (i != kHub) spokes.push_back({std::min(i, kHub), std::max(i, kHub)});
    return spokes;
}

/// Of the triangle of the hub and two vertices.
Slab slab_of(const std::vector<glm::dvec3>& positions, std::uint32_t a, std::uint32_t b) {
    const glm::dvec3 normal = glm::normalize(glm::cross(positions[a], positions[b]));
    const auto frame = meshing::frame_along(positions[kHub], positions[a], normal);
    return {frame, {2, 2}, 1e-9};
}

TEST(SegmentTree, FindsTheTwoSpokesOfATriangleOfAFan) {
    const auto positions = wave();
    const SegmentTree tree(positions, spokes());

    const auto found = tree.in(slab_of(positions, 10, 11));

    EXPECT_EQ(found, (std::vector<std::uint32_t>{10, 11}));
}

TEST(SegmentTree, FindsNoneBesideTheRectangle) {
    const std::vector<glm::dvec3> positions{{0, 1, 0}, {0.9, 1, 0}, {1.1, 1, 0}, {3, 1, 0}};
    const SegmentTree tree(positions, {{0, 1}, {2, 3}});

    const auto found = tree.in({{{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1, 2}, 1e-9});

    EXPECT_EQ(found, (std::vector<std::uint32_t>{0}));
}

/// The hub lies in the planes of all triangles, and so every box that is about a spoke meets them.
TEST(SegmentTree, LooksAtFewOfTheSpokesOfAFan) {
    const auto positions = wave();
    const SegmentTree tree(positions, spokes());
    std::size_t looks = 0;

    for (std::uint32_t i = 0; i < 100; ++i) tree.in(slab_of(positions, i, i + 1), &looks);

    EXPECT_LT(looks, 100 * kSpokes / 20);
}

}  // namespace
}  // namespace hemirad::test::segment_tree_test
