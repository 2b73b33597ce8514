#include <gtest/gtest.h>

#include <ctime>

#include "scene/scenes_by_hand.h"
#include "support/seconds_since.h"

namespace hemirad::mesh_faults_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

bool warns(const Mesh& mesh, const std::string& words) {
    return std::ranges::any_of(mesh.warnings, [&](const std::string& warning) {
        return warning.find(words) != std::string::npos;
    });
}

Faces at_height(Faces faces, double z) {
    for (auto& face : faces)
        for (auto& p : face) p.z += z;
    return faces;
}

TEST(Faults, AreCountedByKind) {
    const auto quad = rectangle(0, 0, 1, 1);
    const Faces faces{quad,
                      quad,
                      {{5, 0, 0}, {6, 0, 0}, {7, 0, 0}},
                      {{2, 2, 0}, {3, 3, 0}, {3, 2, 0}, {2, 3, 0}},
                      {{4, 4, 0}, {5, 4, 0}, {5, 5, 1}, {4, 5, 0}}};

    const InputFaults input = mesh_of(faces, 10).input;

    EXPECT_EQ(input.duplicate, 1u);
    EXPECT_EQ(input.degenerate, 1u);
    EXPECT_EQ(input.crossing, 1u);
    EXPECT_EQ(input.split, 1u);
    EXPECT_EQ(input.welded + input.moved + input.overlapping + input.inside_out, 0u);
}

TEST(Faults, PositionsThatAreDrawnToOthersAreWelded) {
    auto right = rectangle(1, 0, 2, 1);
    for (auto& p : right) p += 3e-7;

    EXPECT_EQ(mesh_of({rectangle(0, 0, 1, 1), right}, 10).input.welded, 2u);
}

TEST(Faults, PlacesAreToldToNineDigits) {
    const auto far = at_height({rectangle(0, 0, 1000, 1000)}, 12345.25)[0];

    EXPECT_TRUE(warns(mesh_of({far, far}, 100), "at (0, 0, 12345.25) repeats"));
}

TEST(Faults, RepeatedCornersAndSpikesLeaveTheFaceWhole) {
    const Faces faces{
        {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};

    const Mesh mesh = mesh_of(faces, 10);

    ASSERT_EQ(mesh.patches.size(), 1u);
    EXPECT_DOUBLE_EQ(total_area(mesh), 1);
}

TEST(Overlaps, AreToldWithPlaceAndArea) {
    for (const double patch_size : {10.0, 0.1, kUncut}) {
        const Mesh mesh = mesh_of({rectangle(0, 0, 2, 1), rectangle(1.5, 0.5, 3, 2)}, patch_size);

        EXPECT_EQ(mesh.input.overlapping, 1u);
        EXPECT_TRUE(warns(mesh, "faces of \"thing\" and \"thing\" overlap at ("));
        EXPECT_TRUE(warns(mesh, "by 0.25 m^2")) << patch_size;
    }
}

TEST(Overlaps, OfTurnedFacesCountTheAreaInCommonAlone) {
    const Faces faces{rectangle(0, 0, 1, 1), {{1, 0.5, 0}, {2, -0.5, 0}, {3, 0.5, 0}, {2, 1.5, 0}}};

    EXPECT_EQ(mesh_of(faces, kUncut).input.overlapping, 0u);
}

TEST(Overlaps, AreNoneWhereFacesTouchFaceAwayOrLieInPlanesOfTheirOwn) {
    const auto floor = rectangle(0, 0, 1, 1);
    const auto above = at_height({rectangle(0.2, 0.2, 0.8, 0.8)}, 1e-4)[0];

    EXPECT_EQ(mesh_of({floor, rectangle(1, 0.5, 2, 3)}, kUncut).input.overlapping, 0u);
    EXPECT_EQ(mesh_of({floor, reversed(rectangle(0.2, 0.2, 0.8, 0.8))}, 10).input.overlapping, 0u);
    EXPECT_EQ(mesh_of({floor, above}, 10).input.overlapping, 0u);
}

TEST(Overlaps, OfATinyFaceOnALargeOneAreFound) {
    EXPECT_EQ(mesh_of({rectangle(0, 0, 1, 1), rectangle(0.7, 0.2, 0.701, 0.201)}, kUncut)
                  .input.overlapping,
              1u);
}

TEST(Overlaps, OfManyAreSummarised) {
    Faces faces{rectangle(0, 0, 10, 10)};
    for (int i = 0; i < 9; ++i) faces.push_back(rectangle(i, 1, i + 0.5, 2));

    const Mesh mesh = mesh_of(faces, kUncut);

    EXPECT_EQ(mesh.input.overlapping, 9u);
    EXPECT_EQ(mesh.warnings.size(), 6u);
    EXPECT_TRUE(warns(mesh, "and 4 more overlaps"));
}

TEST(Overlaps, AreLookedForInBoundedTime) {
    Scene scene = empty_scene();
    for (int i = 0; i < 50000; ++i) add_face(scene, rectangle(1e-3 * i, 0, 1e-3 * i + 0.9e-3, 50));
    const auto start = std::clock();

    const Mesh mesh = mesh_of(scene, kUncut);

    EXPECT_LT(test::seconds_since(start), 10);
    EXPECT_TRUE(warns(mesh, "too many faces side by side"));
}

TEST(InsideOut, RoomIsTold) {
    Faces faces = solid_box({0, 0, 0}, {3, 3, 3});
    for (const auto& face : solid_box({1, 1, 0}, {2, 2, 1})) faces.push_back(face);

    const Mesh mesh = mesh_of(faces, 10);

    EXPECT_EQ(mesh.input.inside_out, 1u);
    EXPECT_TRUE(warns(mesh, "hand.obj: \"thing\" encloses everything else, which sees the backs"));
    EXPECT_TRUE(warns(mesh, "such as at (0, 0, 0)"));
}

TEST(InsideOut, RoomOfFrontsIsNot) {
    Faces faces = room({0, 0, 0}, {3, 3, 3});
    for (const auto& face : solid_box({1, 1, 0}, {2, 2, 1})) faces.push_back(face);

    EXPECT_EQ(mesh_of(faces, 10).input.inside_out, 0u);
}

TEST(InsideOut, SolidsAloneBesideOthersOrAboutThemAreNot) {
    EXPECT_EQ(mesh_of(solid_box({0, 0, 0}, {1, 1, 1}), 10).input.inside_out, 0u);

    Faces beside = solid_box({0, 0, 0}, {1, 1, 1});
    for (const auto& face : solid_box({2, 0, 0}, {2.5, 0.5, 0.5})) beside.push_back(face);
    EXPECT_EQ(mesh_of(beside, 10).input.inside_out, 0u);

    // An L from above, and a box in its notch, within its bounding box.
    Faces notch{{{0, 0, 0}, {0, 3, 0}, {1, 3, 0}, {1, 1, 0}, {3, 1, 0}, {3, 0, 0}}};
    notch.push_back(reversed(at_height({notch[0]}, 3)[0]));
    for (int i = 0; i < 6; ++i) {
        const auto a = notch[0][(i + 1) % 6], b = notch[0][i];
        notch.push_back({a, b, b + glm::dvec3(0, 0, 3), a + glm::dvec3(0, 0, 3)});
    }
    for (const auto& face : solid_box({1.5, 1.5, 1}, {2, 2, 2})) notch.push_back(face);
    const Mesh mesh = mesh_of(notch, 10);
    EXPECT_TRUE(mesh.parts[0].closed);
    EXPECT_EQ(mesh.input.inside_out, 0u);
}

}  // namespace
}  // namespace hemirad::mesh_faults_test
