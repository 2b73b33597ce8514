#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "errors.h"
#include "scene/scenes_by_hand.h"

namespace hemirad::mesh_faces_test {
namespace {

bool warns(const Mesh& mesh, const std::string& words) {
    return std::ranges::any_of(mesh.warnings, [&](const std::string& warning) {
        return warning.find(words) != std::string::npos;
    });
}

TEST(Welding, JoinsVerticesWithinFloatPrecision) {
    auto right = rectangle(1, 0, 2, 1);
    for (auto& p : right) p += 3e-7;

    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1), right}, 10);

    EXPECT_EQ(mesh.surfaces.size(), 1u);
    EXPECT_EQ(mesh.patches.size(), 1u);
    EXPECT_EQ(mesh.parts.size(), 1u);
}

TEST(Welding, KeepsVerticesApartThatDiffer) {
    auto right = rectangle(1, 0, 2, 1);
    for (auto& p : right) p += glm::dvec3(1e-5, 0, 0);

    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1), right}, 10);

    EXPECT_EQ(mesh.surfaces.size(), 2u);
    EXPECT_EQ(mesh.parts.size(), 2u);
}

TEST(Faces, WithoutAreaAreDroppedWithPlaceAndObject) {
    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1),
                               {{5, 6, 7}, {6, 6, 7}, {7, 6, 7}},
                               {{0, 0, 0}, {0, 0, 0}, {1, 1, 1}}},
                              10);

    EXPECT_EQ(mesh.dropped_degenerate, 2u);
    EXPECT_EQ(mesh.face_count, 3u);
    EXPECT_EQ(mesh.patches.size(), 1u);
    EXPECT_TRUE(warns(mesh, "hand.obj: face 1 of \"thing\" at (5, 6, 7) has no area"));
}

TEST(Faces, WithFewerThanThreeCornersAreDropped) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    scene.faces.push_back({{0, 1}, 0, 0});
    scene.faces.push_back({{}, 0, 0});

    EXPECT_EQ(mesh_of(scene, 10).dropped_degenerate, 2u);
}

TEST(Faces, ManyOfAKindAreSummarised) {
    std::vector<std::vector<glm::dvec3>> faces{rectangle(0, 0, 1, 1)};
    for (int i = 0; i < 100; ++i) faces.push_back({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});

    const Mesh mesh = mesh_of(faces, 10);

    EXPECT_EQ(mesh.dropped_degenerate, 100u);
    EXPECT_EQ(mesh.warnings.size(), 6u);
    EXPECT_TRUE(warns(mesh, "95 more faces"));
}

TEST(Faces, ThatRepeatAnotherAreDropped) {
    const auto quad = rectangle(0, 0, 1, 1);

    const Mesh mesh = mesh_of({quad, {quad[2], quad[3], quad[0], quad[1]}, quad}, 10);

    EXPECT_EQ(mesh.dropped_duplicate, 2u);
    EXPECT_EQ(mesh.patches.size(), 1u);
    EXPECT_TRUE(warns(mesh, "face 1 of"));
}

TEST(Faces, ThatFaceTheOtherWayAreNoDuplicates) {
    const auto quad = rectangle(0, 0, 1, 1);

    const Mesh mesh = mesh_of({quad, reversed(quad)}, 10);

    EXPECT_EQ(mesh.dropped_duplicate, 0u);
    EXPECT_EQ(mesh.patches.size(), 2u);
}

TEST(Faces, BowTiesAreDropped) {
    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1),
                               {{2, 0, 0}, {3, 1, 0}, {3, 0, 0}, {2, 1, 0}},
                               {{4, 0, 0}, {6, 2, 0}, {6, 0, 0}, {4, 1, 0}}},
                              10);

    EXPECT_EQ(mesh.dropped_degenerate, 2u);
    EXPECT_EQ(mesh.patches.size(), 1u);
    EXPECT_TRUE(warns(mesh, "crosses itself"));
}

TEST(Faces, PentagramIsDropped) {
    std::vector<glm::dvec3> star;
    for (int i = 0; i < 5; ++i) star.push_back({std::cos(i * 2.513274), std::sin(i * 2.513274), 0});

    const Mesh mesh = mesh_of({rectangle(2, 0, 3, 1), star}, 10);

    EXPECT_EQ(mesh.dropped_degenerate, 1u);
}

TEST(Faces, ThatGoRoundTwiceAreDropped) {
    const Mesh mesh = mesh_of({rectangle(9, 0, 10, 1),
                               {{0, 0, 0},
                                {3, 0, 0},
                                {3, 3, 0},
                                {0, 3, 0},
                                {0.5, 1, 0},
                                {2, 1, 0},
                                {2, 2, 0},
                                {-1, 2, 0}}},
                              kUncut);

    EXPECT_EQ(mesh.dropped_degenerate, 1u);
    EXPECT_EQ(mesh.patches.size(), 1u);
}

TEST(Faces, CrossedOnesAreDroppedAlsoWhereEarsCouldBeClipped) {
    const Mesh mesh = mesh_of(
        {rectangle(9, 0, 10, 1), {{2, 3, 0}, {0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {1, 0, 0}}}, kUncut);

    EXPECT_EQ(mesh.dropped_degenerate, 1u);
}

TEST(Faces, WarpedQuadIsSplitAlongItsShorterDiagonal) {
    const Mesh mesh = mesh_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}}, 10);

    EXPECT_TRUE(warns(mesh, "is not planar"));
    ASSERT_EQ(mesh.patches.size(), 2u);
    EXPECT_NEAR(mesh.area(mesh.patches[0]), 0.5, 1e-15);
    EXPECT_EQ(mesh.dropped_degenerate, 0u);
}

TEST(Faces, ConcaveQuadIsSplitAtItsReflexCorner) {
    const Mesh mesh = mesh_of({{{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}}}, kUncut);

    EXPECT_EQ(mesh.patches.size(), 2u);
    EXPECT_NEAR(total_area(mesh), 1, 1e-15);
    EXPECT_TRUE(mesh.warnings.empty());
}

TEST(Faces, CombOfManyTeethKeepsItsArea) {
    std::vector<glm::dvec3> comb{{0, -1, 0}, {20, -1, 0}};
    for (int i = 20; i > 0; --i) {
        comb.push_back({i, 1, 0});
        comb.push_back({i - 0.5, 0, 0});
    }

    const Mesh mesh = mesh_of({comb}, kUncut);

    double area = 0;
    for (std::size_t i = 0; i < comb.size(); ++i)
        area += glm::cross(comb[i], comb[(i + 1) % comb.size()]).z / 2;
    EXPECT_NEAR(total_area(mesh), area, 1e-12);
}

TEST(Faces, NothingLeftIsAnInputError) {
    EXPECT_THROW(mesh_of({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}, 1), InputError);
    EXPECT_THROW(mesh_of(empty_scene(), 1), InputError);
}

TEST(Faces, PatchesTooSlenderForTheirNeighboursAreTold) {
    EXPECT_TRUE(warns(mesh_of({rectangle(0, 0, 2e4, 1)}, kUncut),
                      "hand.obj: 1 patch is more than 10,000 times as long as wide, such as at "
                      "(10000, 0.5, 0)"));
    EXPECT_TRUE(mesh_of({rectangle(0, 0, 9e3, 1)}, kUncut).warnings.empty());
    EXPECT_TRUE(mesh_of({rectangle(0, 0, 2e4, 1)}, 100).warnings.empty());
}

TEST(Faces, PatchSizeOutOfRangeIsAnInputError) {
    const auto wall = rectangle(0, 0, 1, 1);
    EXPECT_THROW(mesh_of({wall}, -1), InputError);
    EXPECT_THROW(mesh_of({wall}, std::nan("")), InputError);
    EXPECT_THROW(mesh_of({wall}, 1e-9), InputError);
    EXPECT_THROW(mesh_of({wall}, 1e-5), InputError);
    // Fewer than 100 million on every wall, but not on all six; told before any is made.
    EXPECT_THROW(mesh_of(room({0, 0, 0}, {1, 1, 1}), 1.3e-4), InputError);
}

TEST(Faces, HugeTinyAndDistantWorldsGiveTheSameMesh) {
    for (const double scale : {1e-69, 1e-30, 1e-3, 1e6, 1e30, 9e69}) {
        auto faces = room({0, 0, 0}, {scale, scale, scale});
        EXPECT_EQ(mesh_of(faces, 0.2 * scale).patches.size(), 150u) << scale;
    }
    EXPECT_THROW(mesh_of({rectangle(0, 0, 1e200, 1e200)}, 1), InputError);
    EXPECT_THROW(mesh_of({rectangle(0, 0, 1e71, 1e71)}, 1e71), InputError);
    EXPECT_THROW(mesh_of({rectangle(0, 0, 1e-71, 1e-71)}, 1e-71), InputError);
}

TEST(Materials, ReflectanceIsLimitedWithOneWarning) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    scene.materials = {grey(1.0), grey(0.3), grey(1.0)};
    scene.materials[0].name = "paper";
    scene.materials[2].name = "unused";

    const Mesh mesh = mesh_of(scene, 10);

    EXPECT_DOUBLE_EQ(mesh.materials[0].reflectance[0], 0.98);
    EXPECT_DOUBLE_EQ(mesh.materials[1].reflectance[0], 0.3);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_EQ(mesh.warnings[0], "hand.obj: reflectance limited to 0.98 in material \"paper\"");
}

TEST(Materials, LastIsABlackAbsorber) {
    const Mesh mesh = mesh_of({rectangle(0, 0, 1, 1)}, 10);

    ASSERT_EQ(mesh.materials.size(), 2u);
    EXPECT_EQ(mesh.materials[1].name, "back");
    EXPECT_EQ(mesh.materials[1].reflectance, std::vector<double>{0.0});
    EXPECT_EQ(mesh.materials[1].emission, std::vector<double>{0.0});
}

TEST(Warnings, OfTheSceneComeFirst) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1), {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}});
    scene.warnings = {"from the reader"};

    const Mesh mesh = mesh_of(scene, 10);

    ASSERT_EQ(mesh.warnings.size(), 2u);
    EXPECT_EQ(mesh.warnings[0], "from the reader");
}

}  // namespace
}  // namespace hemirad::mesh_faces_test
