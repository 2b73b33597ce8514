#include "solver/find_rims.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <ctime>

#include "scene/scenes_by_hand.h"
#include "solver/support.h"
#include "support/seconds_since.h"

namespace hemirad::test::find_rims_test {
namespace {

int rims_of(const Mesh& mesh) {
    int count = 0;
    for (const auto bits : find_rims(mesh, 4)) count += std::popcount(bits);
    return count;
}

Scene sheet(const std::vector<std::vector<glm::dvec3>>& faces) {
    Scene scene;
    scene.file = "rims";
    scene.bands = {"Y"};
    scene.objects = {"a", "b"};
    scene.materials = {{"plaster", {0.5}, {1}, false}, {"paper", {0.5}, {1}, true}};
    for (std::uint32_t i = 0; i < faces.size(); ++i) add_face(scene, faces[i], 0, i);
    return scene;
}

const std::vector<glm::dvec3> kLeft = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};

TEST(FindRims, OnlyTheOutlineOfAGridIsOne) {
    const Mesh mesh = meshed(sheet({kLeft}), 1, Backfaces::cull);

    EXPECT_EQ(mesh.patches.size(), 6u);
    EXPECT_EQ(rims_of(mesh), 10);
}

TEST(FindRims, ASurfaceGoesOnInAnotherOfItsPlane) {
    const std::vector<glm::dvec3> right = {{3, 0, 0}, {5, 0, 0}, {5, 2, 0}, {3, 2, 0}};

    EXPECT_EQ(rims_of(meshed(sheet({kLeft, right}), 1, Backfaces::cull)), 14);
}

TEST(FindRims, ItEndsWhereAnotherStandsOnEdge) {
    const std::vector<glm::dvec3> upright = {{3, 0, 0}, {3, 0, 2}, {3, 2, 2}, {3, 2, 0}};

    EXPECT_EQ(rims_of(meshed(sheet({kLeft, upright}), 1, Backfaces::cull)), 10 + 8);
}

TEST(FindRims, TrianglesHaveThreeEdgesWhereThereIsNothingElse) {
    const Mesh mesh = meshed(sheet({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}), 9, Backfaces::cull);

    EXPECT_EQ(find_rims(mesh, 3), std::vector<std::uint8_t>{0b0111});
    EXPECT_EQ(find_rims(mesh, 4), std::vector<std::uint8_t>{0b1011});
}

TEST(FindRims, AFanOfManySurfacesAtOneEdgeIsNotComparedPairByPair) {
    constexpr std::uint32_t kPairs = 200'000;
    Mesh mesh;
    for (std::uint32_t i = 0; i < kPairs; ++i) {
        Surface surface;
        surface.plane = i;
        surface.normal = {0, 0, 1};
        for (const bool back : {false, true}) {
            Patch patch{};
            patch.corners = {0, 1, 2 + i, 2 + i};
            if (back) std::swap(patch.corners[0], patch.corners[1]);
            patch.surface = static_cast<std::uint32_t>(mesh.surfaces.size());
            mesh.patches.push_back(patch);
            mesh.surfaces.push_back(surface);
        }
    }
    const auto start = std::clock();

    const auto rims = find_rims(mesh, 3);

    // A fifth of a second; pair by pair minutes.
    EXPECT_LT(seconds_since(start), 20);
    // Patches of a pair share all three edges.
    EXPECT_EQ(std::ranges::count(rims, 0), std::ptrdiff_t{2 * kPairs});
}

// A sheet's front and back share edges, but face apart.
TEST(FindRims, TheBackIsNotASurfaceGoneOn) {
    Scene paper = sheet({kLeft});
    paper.faces[0].material = 1;

    EXPECT_EQ(rims_of(meshed(paper, 1)), 20);
}

}  // namespace
}  // namespace hemirad::test::find_rims_test
