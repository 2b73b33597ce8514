#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/scenes_by_hand.h"

namespace hemirad::mesh_parts_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

Faces operator+(Faces a, const Faces& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Scene double_sided(const Faces& faces) {
    Scene scene = scene_of(faces);
    scene.materials[0].double_sided = true;
    return scene;
}

Faces without_last(Faces faces) {
    faces.pop_back();
    return faces;
}

const Faces kRoom = room({0, 0, 0}, {1, 1, 1});
const Faces kSolid = solid_box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75});
const Faces kSheet = {rectangle(0, 0, 1, 1)};

TEST(Parts, RoomIsClosed) {
    const Mesh mesh = mesh_of(kRoom, 10);

    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_TRUE(mesh.parts[0].closed);
    EXPECT_EQ(mesh.parts[0].face_count, 6u);
    EXPECT_TRUE(mesh.closed);
}

TEST(Parts, RoomWithoutAWallIsOpen) {
    const Mesh mesh = mesh_of(without_last(kRoom), 10);

    EXPECT_FALSE(mesh.parts[0].closed);
    EXPECT_FALSE(mesh.closed);
}

TEST(Parts, RoomWithAWallTurnedRoundIsOpen) {
    Faces faces = kRoom;
    faces[0] = reversed(faces[0]);

    EXPECT_FALSE(mesh_of(faces, 10).parts[0].closed);
}

TEST(Parts, SolidAloneIsClosedButLightEscapes) {
    const Mesh mesh = mesh_of(kSolid, 10);

    EXPECT_TRUE(mesh.parts[0].closed);
    EXPECT_FALSE(mesh.closed);
}

TEST(Parts, SolidInARoomLetsNothingEscape) {
    const Mesh mesh = mesh_of(kSolid + kRoom, 10);

    EXPECT_EQ(mesh.parts.size(), 2u);
    EXPECT_TRUE(mesh.closed);
}

TEST(Parts, TouchingInAVertexDoesNotConnect) {
    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1), rectangle(1, 1, 2, 2)}, 10);

    EXPECT_EQ(mesh.parts.size(), 2u);
}

TEST(Parts, ReachAcrossObjectsAndMaterials) {
    Scene scene = empty_scene();
    scene.objects = {"floor", "walls"};
    scene.materials = {grey(), grey()};
    for (std::uint32_t i = 0; i < kRoom.size(); ++i) add_face(scene, kRoom[i], i > 2, i > 2);

    const Mesh mesh = mesh_of(scene, 10);

    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_EQ(mesh.parts[0].objects, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_TRUE(mesh.parts[0].closed);
}

TEST(Parts, TJunctionsClose) {
    Faces faces = kRoom;
    const auto wall = faces.back();
    faces.pop_back();
    const auto middle = [&](int a, int b) { return 0.5 * (wall[a] + wall[b]); };
    faces.push_back({wall[0], middle(0, 1), middle(2, 3), wall[3]});
    faces.push_back({middle(0, 1), wall[1], wall[2], middle(2, 3)});

    const Mesh mesh = mesh_of(faces, 10);

    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_TRUE(mesh.closed);
}

TEST(Parts, TJunctionWithAGapStaysOpen) {
    Faces faces = kRoom;
    const auto wall = faces.back();
    faces.pop_back();
    const auto at = [&](int a, int b, double f) { return wall[a] + f * (wall[b] - wall[a]); };
    faces.push_back({wall[0], at(0, 1, 0.5), at(3, 2, 0.5), wall[3]});
    faces.push_back({at(0, 1, 0.6), wall[1], wall[2], at(3, 2, 0.6)});

    EXPECT_FALSE(mesh_of(faces, 10).closed);
}

// From each edge to the next it bends by less than coordinates are precise to.
TEST(Parts, ARoundRimIsOpenHoweverFineItIs) {
    constexpr int kCorners = 64;
    std::vector<glm::dvec3> disc;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCorners;
        disc.emplace_back(0.25 * std::cos(angle), 0.25 * std::sin(angle), 0);
    }
    Scene scene = scene_of({disc});
    scene.quantum = 5e-4;
    const Mesh mesh = mesh_of(scene, 10, Backfaces::automatic);

    EXPECT_FALSE(mesh.parts[0].closed);
    EXPECT_GT(back_count(mesh), 0u);
}

TEST(Parts, DoubledTellsOfDoubleSidedMaterials) {
    EXPECT_TRUE(mesh_of(double_sided(kRoom), 10).parts[0].doubled);
    EXPECT_FALSE(mesh_of(kRoom, 10).parts[0].doubled);
}

TEST(Backs, ClosedPartsGetNone) {
    EXPECT_EQ(back_count(mesh_of(kSolid + kRoom, 10, Backfaces::automatic)), 0u);
}

TEST(Backs, OpenSheetGetsOneBlackPatch) {
    const Mesh mesh = mesh_of(halves(kSheet[0]), 0.1, Backfaces::automatic);

    ASSERT_EQ(mesh.surfaces.size(), 2u);
    const Surface& back = mesh.surfaces[1];
    EXPECT_TRUE(back.is_back);
    EXPECT_FALSE(back.has_chart);
    EXPECT_EQ(back.material, mesh.materials.size() - 1);
    EXPECT_EQ(back.patch_count, 1u);
    EXPECT_EQ(mesh.parts[0].back_patches, 1u);
    EXPECT_NEAR(mesh.normal(mesh.patches[back.first_patch]).z, -1, 1e-15);
}

TEST(Backs, OnlyOpenPartsGetThem) {
    auto far_sheet = rectangle(0, 0, 1, 1);
    for (auto& p : far_sheet) p.z += 5;

    const Mesh mesh = mesh_of(kRoom + Faces{far_sheet}, 10, Backfaces::automatic);

    EXPECT_EQ(back_count(mesh), 1u);
    EXPECT_EQ(mesh.parts[0].back_patches, 0u);
    EXPECT_EQ(mesh.parts[1].back_patches, 1u);
}

TEST(Backs, ASolidAroundALampGetsThemAndOneBesideItDoesNot) {
    Scene scene = scene_of(kRoom + kSolid);
    scene.materials.push_back({"lamp", {0.0}, {1.0}, false});
    for (const auto& face : solid_box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6})) add_face(scene, face, 1);
    for (const auto& face : solid_box({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2})) add_face(scene, face);

    const Mesh mesh = build_mesh(scene, {.patch_size = 10});

    ASSERT_EQ(mesh.parts.size(), 4u);
    EXPECT_TRUE(mesh.parts[1].holds_light);
    EXPECT_EQ(mesh.parts[1].back_patches, 6u);
    EXPECT_EQ(back_count(mesh), 6u);
}

// Upright, of an L in the box [0, 3] x [0, 3] x [0, 1]; fronts outside.
Faces l_shaped_solid() {
    const std::vector<glm::dvec2> outline = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    Faces faces(2);
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const auto a = outline[k], b = outline[(k + 1) % outline.size()];
        faces[0].push_back({a.x, a.y, 1});
        faces[1].insert(faces[1].begin(), {a.x, a.y, 0});
        faces.push_back({{a.x, a.y, 0}, {b.x, b.y, 0}, {b.x, b.y, 1}, {a.x, a.y, 1}});
    }
    return faces;
}

TEST(Backs, ManyLampsInASolidsNotchDoNotHideTheOneInside) {
    for (const bool inside : {false, true}) {
        Scene scene = empty_scene();
        scene.materials.push_back({"lamp", {0.0}, {1.0}, false});
        const auto lamp_at = [&](double x, double y) {
            for (const auto& face : solid_box({x, y, 0.4}, {x + 0.1, y + 0.1, 0.6}))
                add_face(scene, face, 1);
        };
        for (int i = 0; i < 30; ++i) lamp_at(1.2 + 0.05 * i, 2);
        if (inside) lamp_at(0.4, 0.4);
        for (const auto& face : l_shaped_solid()) add_face(scene, face);

        const Mesh mesh = build_mesh(scene, {.patch_size = 10});

        EXPECT_TRUE(mesh.parts.back().closed);
        EXPECT_EQ(mesh.parts.back().holds_light, inside);
    }
}

TEST(Backs, BlockGivesThemToClosedPartsToo) {
    EXPECT_EQ(back_count(mesh_of(kSolid, 10, Backfaces::block)), 6u);
}

TEST(Backs, CullGivesNone) { EXPECT_EQ(back_count(mesh_of(kSheet, 10, Backfaces::cull)), 0u); }

TEST(Backs, DoubleSidedSheetIsMirroredInEveryMode) {
    for (const auto mode : {Backfaces::automatic, Backfaces::block, Backfaces::cull}) {
        const Mesh mesh = mesh_of(double_sided(kSheet), 0.25, mode);

        ASSERT_EQ(mesh.surfaces.size(), 2u);
        EXPECT_TRUE(mesh.surfaces[1].is_back);
        EXPECT_TRUE(mesh.surfaces[1].has_chart);
        EXPECT_EQ(mesh.surfaces[1].material, 0u);
        EXPECT_EQ(mesh.surfaces[1].patch_count, 16u);
    }
}

TEST(Backs, DoubleSidedSolidNeedsNoneUnlessBlocked) {
    EXPECT_EQ(back_count(mesh_of(double_sided(kSolid), 10, Backfaces::automatic)), 0u);
    EXPECT_EQ(back_count(mesh_of(double_sided(kSolid), 10, Backfaces::cull)), 0u);
    EXPECT_EQ(back_count(mesh_of(double_sided(kSolid), 10, Backfaces::block)), 6u);
}

TEST(Backs, SheetOfTwoOppositeFacesNeedsNone) {
    const Faces two{kSheet[0], reversed(kSheet[0])};
    for (const auto mode : {Backfaces::automatic, Backfaces::block})
        EXPECT_EQ(back_count(mesh_of(two, 10, mode)), 0u);
}

TEST(Backs, OnlyTheModelledPartOfASheetGoesWithout) {
    const Faces faces{rectangle(0, 0, 1, 1), reversed(rectangle(0, 0, 1, 1)),
                      rectangle(1, 0, 2, 1)};

    const Mesh mesh = mesh_of(faces, 10, Backfaces::automatic);

    EXPECT_EQ(back_count(mesh), 1u);
    EXPECT_GT(mesh.centroid(mesh.patches.back()).x, 1);
}

TEST(Backs, ConcaveFaceIsCoveredByFewConvexPatches) {
    const Faces l_shape{{{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}}};

    const Mesh mesh = mesh_of(l_shape, 0.1, Backfaces::automatic);

    EXPECT_LE(back_count(mesh), 3u);
    EXPECT_NEAR(total_area(mesh), 12, 1e-10);
}

TEST(Backs, HaveNoFragments) {
    const Mesh mesh = mesh_of(kSheet, 0.5, Backfaces::automatic);

    EXPECT_EQ(mesh.fragments.size(), 4u);
    for (const Fragment& fragment : mesh.fragments)
        EXPECT_FALSE(mesh.surfaces[mesh.patches[fragment.patch].surface].is_back);
}

}  // namespace
}  // namespace hemirad::mesh_parts_test
