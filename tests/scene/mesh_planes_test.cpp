#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "scene/scenes_by_hand.h"
#include "support/seconds_since.h"

namespace hemirad::mesh_planes_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

// Twice four float ulps of a largest coordinate of 1 m, as Precision::plane.
constexpr double kPlanePrecision = 8 * 0x1p-23;

std::size_t plane_count(const Mesh& mesh) {
    std::set<std::uint32_t> planes;
    for (const Surface& surface : mesh.surfaces) planes.insert(surface.plane);
    return planes.size();
}

glm::dvec3 turned(const glm::dvec3& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}

Faces turned(Faces faces, double angle) {
    for (auto& face : faces)
        for (auto& p : face) p = turned(p, angle);
    return faces;
}

Faces rounded_to_floats(Faces faces) {
    for (auto& face : faces)
        for (auto& p : face) p = glm::dvec3(glm::vec3(p));
    return faces;
}

// The longest stretch of an axis that the vertices of one plane take up.
double longest_stretch(const Mesh& mesh, int axis) {
    std::map<std::uint32_t, std::pair<double, double>> stretch;
    for (const Patch& patch : mesh.patches)
        for (const std::uint32_t v : patch.corners) {
            const double at = mesh.vertices[v][axis];
            const auto plane = mesh.surfaces[patch.surface].plane;
            auto& [low, high] = stretch.try_emplace(plane, at, at).first->second;
            low = std::min(low, at), high = std::max(high, at);
        }
    double longest = 0;
    for (const auto& [plane, s] : stretch) longest = std::max(longest, s.second - s.first);
    return longest;
}

TEST(Planes, OfARoomAreSix) {
    EXPECT_EQ(plane_count(mesh_of(room({0, 0, 0}, {1, 1, 1}), 0.3)), 6u);
}

TEST(Planes, AreSharedWithWhatLiesOnAFloorHangsOnAWallOrFacesAway) {
    Scene scene = scene_of(room({0, 0, 0}, {1, 1, 1}));
    scene.materials.push_back(grey());
    scene.objects = {"room", "crate", "picture"};
    for (const auto& face : solid_box({0.2, 0.2, 0}, {0.4, 0.4, 0.2})) add_face(scene, face, 0, 1);
    add_face(scene, {{0, 0.4, 0.4}, {0, 0.6, 0.4}, {0, 0.6, 0.6}, {0, 0.4, 0.6}}, 1, 2);

    const Mesh mesh = mesh_of(scene, 10);

    std::map<std::uint32_t, std::set<std::uint32_t>> objects;
    for (const Surface& surface : mesh.surfaces) objects[surface.plane].insert(surface.object);
    ASSERT_EQ(mesh.surfaces.size(), 13u);
    EXPECT_EQ(objects.size(), 6u + 5u);
    EXPECT_EQ(std::ranges::count_if(objects, [](const auto& o) { return o.second.size() == 2; }),
              2);
}

TEST(Planes, AreSharedByFrontsAndBacks) {
    for (const bool double_sided : {false, true}) {
        Scene scene = scene_of({rectangle(0, 0, 1, 1)});
        scene.materials[0].double_sided = double_sided;

        const Mesh mesh = mesh_of(scene, 0.25, Backfaces::automatic);

        ASSERT_EQ(mesh.surfaces.size(), 2u);
        EXPECT_EQ(mesh.surfaces[0].plane, mesh.surfaces[1].plane);
    }
}

TEST(Planes, ReachAcrossGaps) {
    const Mesh mesh = mesh_of(
        {rectangle(0, 0, 0.1, 0.1), rectangle(0.9, 0.9, 1, 1), rectangle(0, 0.5, 1, 0.6)}, 10);

    EXPECT_EQ(mesh.surfaces.size(), 3u);
    EXPECT_EQ(plane_count(mesh), 1u);
}

TEST(Planes, EndWhereAVertexLeavesThemByMoreThanThePrecision) {
    for (const double step : {0.9, 1.1}) {
        auto shelf = rectangle(0.5, 0, 0.6, 0.1);
        for (auto& p : shelf) p.z = step * kPlanePrecision;

        const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1), shelf}, 10);

        EXPECT_EQ(plane_count(mesh), step < 1 ? 1u : 2u);
    }
}

TEST(Planes, DoNotDriftOverAStackOfTinySteps) {
    Faces stack;
    for (int i = 0; i < 100; ++i) {
        stack.push_back(rectangle(0, 0, 1, 1));
        for (auto& p : stack.back()) p.z = 0.9 * i * kPlanePrecision;
    }

    const Mesh mesh = mesh_of(stack, kUncut);

    EXPECT_LE(longest_stretch(mesh, 2), 2 * kPlanePrecision);
    EXPECT_GE(plane_count(mesh), 100u / 3);
}

TEST(Planes, DoNotDriftRoundAFineCylinder) {
    constexpr int kFacets = 20000;
    Faces facets;
    const auto at = [](int i, double z) {
        const double angle = 2 * std::numbers::pi * i / kFacets;
        return glm::dvec3(0.5 * std::cos(angle), 0.5 * std::sin(angle), z);
    };
    for (int i = 0; i < kFacets; ++i)
        facets.push_back({at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1)});

    const Mesh mesh = mesh_of(facets, kUncut);

    // The chord of an arc that rises by twice the precision.
    const double chord = 2 * std::sqrt(2 * 0.5 * 2 * kPlanePrecision);
    EXPECT_LE(longest_stretch(mesh, 0), chord);
    EXPECT_LE(longest_stretch(mesh, 1), chord);
    EXPECT_GE(plane_count(mesh), std::numbers::pi / chord);
}

TEST(Planes, TellApartWhatStandsUprightHoweverLowItIs) {
    const double low = 0.95 * kPlanePrecision;
    const std::vector<glm::dvec3> kerb{
        {0, 0.5, -low}, {1, 0.5, -low}, {1, 0.5, low}, {0, 0.5, low}};

    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1), kerb}, 10);

    ASSERT_EQ(mesh.surfaces.size(), 2u);
    EXPECT_EQ(plane_count(mesh), 2u);
}

TEST(Planes, OfTilesRoundedToFloatsAreOne) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(0, 3);
    for (int run = 0; run < 20; ++run) {
        Faces tiles;
        for (int x = 0; x < 40; ++x)
            for (int y = 0; y < 40; ++y)
                tiles.push_back(rectangle(0.02 * x, 0.02 * y, 0.02 * x + 0.019, 0.02 * y + 0.019));

        const Mesh mesh = mesh_of(rounded_to_floats(turned(tiles, any(random))), kUncut);

        EXPECT_EQ(mesh.surfaces.size(), 1600u);
        EXPECT_EQ(plane_count(mesh), 1u) << "run " << run;
    }
}

TEST(Planes, OfParallelWallsDiffer) {
    Faces walls;
    for (int i = 0; i < 1000; ++i) {
        walls.push_back(rectangle(0, 0, 1, 1));
        for (auto& p : walls.back()) p.z = 0.001 * i;
    }

    EXPECT_EQ(plane_count(mesh_of(turned(walls, 0.3), 10)), 1000u);
}

TEST(Planes, OfHundredsOfThousandsOfSurfacesTakeSeconds) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> any(-1, 1);
    Scene scene = empty_scene();
    for (int i = 0; i < 300000 / 6; ++i) {
        const glm::dvec3 low(any(random), any(random), any(random));
        for (const auto& face : turned(solid_box(low, low + 0.01), i % 2 ? 3 * any(random) : 0.0))
            add_face(scene, face);
    }
    const auto start = std::clock();

    const Mesh mesh = mesh_of(scene, kUncut);
    const double seconds = test::seconds_since(start);

    EXPECT_GT(mesh.surfaces.size(), 299000u);
    EXPECT_GT(plane_count(mesh), 200000u);
    EXPECT_LT(seconds, 8);
}

}  // namespace
}  // namespace hemirad::mesh_planes_test
