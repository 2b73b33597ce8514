#include "view/first_hit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <random>

#include "lit_scenes.h"

namespace hemirad::first_hit_test {
namespace {

TEST(FirstHit, TheNearerFaceHidesTheFarther) {
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    add_wall(lit, -5);
    add_wall(lit, -3);

    const auto hit = FirstHit(lit.scene)({0, 0, 0}, {0.1, 0.2, -1});

    ASSERT_TRUE(hit);
    EXPECT_GE(hit->face, 2u);
    EXPECT_NEAR(hit->distance, 3, 1e-12);
}

TEST(FirstHit, BacksAndWhatLiesBehindTheEyeAreNotSeen) {
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    add_wall(lit, -5);
    const FirstHit first_hit(lit.scene);

    EXPECT_FALSE(first_hit({0, 0, -9}, {0, 0, 1}));
    EXPECT_FALSE(first_hit({0, 0, 0}, {0, 0, 1}));
    EXPECT_FALSE(first_hit({0, 0, 0}, {30, 0, -5}));
}

TEST(FirstHit, WeightsGiveThePointBack) {
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    add_triangle(lit, {{-1, -1, -2}, {4, -1, -9}, {0, 3, -4}});
    const glm::dvec3 direction(0.1, 0, -1);

    const auto hit = FirstHit(lit.scene)({0, 0, 0}, direction);

    ASSERT_TRUE(hit);
    const auto& p = lit.scene.positions;
    const glm::dvec3 at = hit->weights.x * p[0] + hit->weights.y * p[1] + hit->weights.z * p[2];
    EXPECT_LT(glm::distance(at, hit->distance * direction), 1e-12);
}

// A bowl of 3000 slivers that meet in its middle: towards every direction there is one.
TEST(FirstHit, NoRayPassesBetweenNeighbours) {
    constexpr int kSlivers = 3000;
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    const auto rim = [](int i) {
        const double angle = 2 * 3.14159265358979 * (i % kSlivers) / kSlivers;
        return glm::dvec3(10 * std::cos(angle), 10 * std::sin(angle), -1);
    };
    for (int i = 0; i < kSlivers; ++i) add_triangle(lit, {{0.3, 0.1, -7}, rim(i), rim(i + 1)});
    const FirstHit first_hit(lit.scene);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> part(0, 1);

    for (int i = 0; i < 20000; ++i) {
        // Through a point of an edge, where a hole would be.
        const glm::dvec3 edge = glm::mix(glm::dvec3(0.3, 0.1, -7), rim(i), part(random));
        const glm::dvec3 eye(0.5, -0.2, 0.3);
        EXPECT_TRUE(first_hit(eye, edge - eye)) << i;
    }
}

TEST(FirstHit, FindsWhatTryingAllFacesFinds) {
    LitScene lit = scene_lit_by({1});
    add_material(lit, 0.5, 0);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    const auto point = [&] {
        return glm::dvec3(coordinate(random), coordinate(random), coordinate(random));
    };
    for (int i = 0; i < 200; ++i) add_triangle(lit, {point(), point(), point()});
    std::vector<LitScene> alone(200, scene_lit_by({1}));
    for (std::size_t i = 0; i < alone.size(); ++i) {
        alone[i].scene.positions = lit.scene.positions;
        alone[i].scene.faces = {lit.scene.faces[i]};
    }

    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 eye = point(), direction = point();
        const auto hit = FirstHit(lit.scene)(eye, direction);
        double nearest = 1e9;
        for (const LitScene& one : alone)
            if (const auto other = FirstHit(one.scene)(eye, direction))
                nearest = std::min(nearest, other->distance);
        EXPECT_EQ(hit ? hit->distance : 1e9, nearest);
    }
}

}  // namespace
}  // namespace hemirad::first_hit_test
