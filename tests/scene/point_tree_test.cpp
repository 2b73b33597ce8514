#include "scene/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <random>

namespace hemirad::meshing {
namespace {

std::vector<std::uint32_t> near_one_by_one(const std::vector<glm::dvec3>& points,
                                           const glm::dvec3& from, const glm::dvec3& to,
                                           double distance) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const double t = glm::dot(points[i] - from, to - from) / glm::dot(to - from, to - from);
        if (t > 0 && t < 1 && glm::distance(points[i], from + t * (to - from)) <= distance)
            found.push_back(i);
    }
    return found;
}

// On a coarse grid many coordinates are alike, as those of walls are.
TEST(PointTree, FindsEveryPointNearASegment) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> step(0, 20);
    const auto point = [&] { return 0.05 * glm::dvec3(step(random), step(random), step(random)); };
    std::vector<glm::dvec3> points;
    for (int i = 0; i < 2000; ++i) points.push_back(point());
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0u);
    const PointTree tree(points, all);
    std::size_t count = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 from = point(), to = i % 2 == 0 ? point() : from + glm::dvec3(0, 0.5, 0);
        if (from == to) continue;

        auto found = tree.near(from, to, 1e-3);

        std::ranges::sort(found);
        EXPECT_EQ(found, near_one_by_one(points, from, to, 1e-3));
        count += found.size();
    }
    EXPECT_GT(count, 100u);
}

}  // namespace
}  // namespace hemirad::meshing
