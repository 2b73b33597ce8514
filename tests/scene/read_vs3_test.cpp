#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/mesh.h"
#include "scene/scene_folder.h"

namespace hemirad::test::read_vs3_test {
namespace {

using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ReadVs3 : public ::testing::Test {
  protected:
    Scene read(const std::string& text) const { return folder_.read("room.vs3", text); }
    std::string error_of(const std::string& text) const {
        return folder_.error_of("room.vs3", text);
    }

  private:
    SceneFolder folder_;
};

/// A square of 4 m, a smaller one in its middle, a triangle's apex and one more above.
const std::string kVertices =
    "F 3\n"
    "V 1 0 0 0\nV 2 4 0 0\nV 3 4 4 0\nV 4 0 4 0\n"
    "V 5 1 1 0\nV 6 3 1 0\nV 7 3 3 0\nV 8 1 3 0\n"
    "V 9 0 0 2\n";
const std::string kFloor = "S 1 1 2 3 4 0 0 0.9 floor\n";

std::vector<glm::dvec3> corners_of(const Scene& scene, std::size_t face) {
    std::vector<glm::dvec3> corners;
    for (const auto vertex : scene.faces.at(face).vertices)
        corners.push_back(scene.positions.at(vertex));
    return corners;
}

double area_of(const Scene& scene, std::uint32_t object) {
    const Mesh mesh = build_mesh(scene, {.patch_size = INFINITY, .backfaces = Backfaces::cull});
    double area = 0;
    for (const Patch& patch : mesh.patches)
        if (mesh.surfaces[patch.surface].object == object) area += mesh.area(patch);
    return area;
}

TEST_F(ReadVs3, SurfacesAreFacesNamedAndGrey) {
    const Scene scene = read("T A floor\nC encl=0 list=3\n" + kVertices + kFloor + "End of data\n");

    EXPECT_THAT(scene.objects, ElementsAre("floor"));
    EXPECT_THAT(corners_of(scene, 0), ElementsAre(glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0),
                                                  glm::dvec3(4, 4, 0), glm::dvec3(0, 4, 0)));
    EXPECT_THAT(scene.bands, ElementsAre("grey"));
    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(DoubleNear(0.1, 1e-15)));
    EXPECT_THAT(scene.materials.at(0).emission, ElementsAre(0));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ReadVs3, BlanksCommasCommentsAndCaseDoNotMatter) {
    const Scene scene = read(
        "! a comment\r\n/ another\r\n\r\nt title of * ! / words\r\nf 3\r\nv,1,0.,0,0 ! here too\r\n"
        "v\t2 1 .5e1 0\r\n  v 3 0 1. +2\r\ns 1 1 2 3 0 0 0 1 /y=0\r\ne\r\nnothing of this is read");

    EXPECT_THAT(corners_of(scene, 0),
                ElementsAre(glm::dvec3(0, 0, 0), glm::dvec3(1, 5, 0), glm::dvec3(0, 1, 2)));
    EXPECT_THAT(scene.objects, ElementsAre("/y=0"));
}

TEST_F(ReadVs3, AStarEndsItToo) {
    EXPECT_EQ(read(kVertices + kFloor + "*\nS 2 1 2 3 4 0 0 0.9 b\n").faces.size(), 1u);
}

TEST_F(ReadVs3, ATriangleHasAFourthVertexOf0OrRepeatsOne) {
    for (const char* vertices : {"1 2 9 0", "1 2 9 9", "1 2 9 1", "1 1 2 9"}) {
        const Scene scene = read(kVertices + "S 1 " + vertices + " 0 0 0.9 gable\n");

        EXPECT_EQ(scene.faces.at(0).vertices.size(), 3u) << vertices;
        EXPECT_DOUBLE_EQ(area_of(scene, 0), 4) << vertices;
    }
}

TEST_F(ReadVs3, ObstructionsAreInTheSceneAndMarked) {
    const Scene scene = read(kVertices + kFloor + "O 2 5 6 7 8 0 0 0.9 ignored\nO 3 1 2 9 0\n");

    EXPECT_THAT(scene.objects, ElementsAre("floor", "obstruction#2", "obstruction#3"));
    EXPECT_THAT(scene.obstructions, ElementsAre(1, 2));
    EXPECT_EQ(scene.faces.size(), 3u);
}

TEST_F(ReadVs3, CombinedSurfacesAreOneObject) {
    const Scene scene = read(kVertices +
                             "S 1 1 2 6 5 0 0 0.9 a\nS 2 2 3 7 6 0 0 0.5 b\n"
                             "S 3 3 4 8 7 0 1 0.9 c\n");

    EXPECT_THAT(scene.objects, ElementsAre("a", "b"));
    EXPECT_EQ(scene.faces.at(2).object, 0u);
    EXPECT_EQ(scene.faces.at(2).material, scene.faces.at(0).material);
}

TEST_F(ReadVs3, ARepeatedNameGetsTheSurfacesNumber) {
    EXPECT_THAT(read(kVertices + kFloor + "S 2 1 2 9 0 0 0 0.9 floor\n").objects,
                ElementsAre("floor", "floor#2"));
}

TEST_F(ReadVs3, ASubsurfaceLeavesAHoleInItsBase) {
    const Scene scene = read(kVertices + kFloor + "S 2 5 6 7 8 1 0 0.9 rug\n");

    EXPECT_DOUBLE_EQ(area_of(scene, 0), 12);
    EXPECT_DOUBLE_EQ(area_of(scene, 1), 4);
}

TEST_F(ReadVs3, ASubsurfaceAtTheEdgeLeavesNoSlivers) {
    const Scene scene = read(
        "F 3\nV 1 0 0 0\nV 2 3 0 0\nV 3 3 2 0\nV 4 0 2 0\nV 5 1 0 0\n"
        "V 6 2 0 0\nV 7 2 1 0\nV 8 1 1 0\n"
        "S 1 1 2 3 4 0 0 0.9 wall\nS 2 5 6 7 8 1 0 0.9 door\n");

    EXPECT_EQ(scene.faces.size(), 4u);  // left, right and above the door, and the door
    EXPECT_DOUBLE_EQ(area_of(scene, 0), 5);
}

TEST_F(ReadVs3, RoundingLeavesNoSliversEither) {
    const Scene scene = read(
        "F 3a\nS 1 R 0 0 0.9 wall\n 0.1 0.7 0.3  33 70  3 2\n"
        "S 2 Q 1 0 0.9 door\n 0.1 0.7 0.3  33 70  0.7 0  1.3 0  1.3 1  0.7 1\n");

    EXPECT_EQ(scene.faces.size(), 4u);
}

TEST_F(ReadVs3, ANullSurfaceIsAHole) {
    const Scene scene =
        read(kVertices + kFloor + "N 2 8 7 6 5 1 0 0.9 well\nS 3 1 2 9 0 0 0 1 b\n");

    EXPECT_THAT(scene.objects, ElementsAre("floor", "b"));
    EXPECT_DOUBLE_EQ(area_of(scene, 0), 12);
}

/// Walls of a room as seen from within: facing north, east, south and west; a floor, a ceiling.
TEST_F(ReadVs3, BlastSurfacesLieInPlanesOfAzimuthAndTilt) {
    const Scene scene = read(
        "F 3a\n"
        "S 1 R 0 0 0.9 south\n 3 0 0  0 90  3 2\n"
        "S 2 r 0 0 0.9 east\n 3 3 0  270 90  3 2\n"
        "S 3 Q 0 0 0.9 floor\n 0 0 0\n 180 0\n 0 0 3 0\n 3 3 0 3\n"
        "S 4 T 0 0 0.9 ceiling\n 3 0 2  0 180  0 0  3 0  3 3\n"
        "O 5 R\n 1 0 0  45 90  1 1\n");

    EXPECT_THAT(corners_of(scene, 0), ElementsAre(glm::dvec3(3, 0, 2), glm::dvec3(3, 0, 0),
                                                  glm::dvec3(0, 0, 0), glm::dvec3(0, 0, 2)));
    EXPECT_THAT(corners_of(scene, 1), ElementsAre(glm::dvec3(3, 3, 2), glm::dvec3(3, 3, 0),
                                                  glm::dvec3(3, 0, 0), glm::dvec3(3, 0, 2)));
    EXPECT_THAT(corners_of(scene, 2), ElementsAre(glm::dvec3(0, 0, 0), glm::dvec3(3, 0, 0),
                                                  glm::dvec3(3, 3, 0), glm::dvec3(0, 3, 0)));
    EXPECT_THAT(corners_of(scene, 3),
                ElementsAre(glm::dvec3(3, 0, 2), glm::dvec3(0, 0, 2), glm::dvec3(0, 3, 2)));
    EXPECT_THAT(corners_of(scene, 4)[3].x, DoubleEq(1 - std::sqrt(0.5)));
    EXPECT_THAT(corners_of(scene, 4)[3].y, DoubleEq(std::sqrt(0.5)));
}

TEST_F(ReadVs3, WhatIsNotFollowedIsWarnedOf) {
    EXPECT_THAT(read("C emit = 1, row=0 eps 1e-4\n" + kVertices + kFloor).warnings,
                ElementsAre("room.vs3: line 1: control \"emit\" is not followed"));
    EXPECT_THAT(read(kVertices + "S 1 1 2 3 4 0 0 0.9 the floor\n").warnings,
                ElementsAre("room.vs3: line 11: \"floor\" is not read: names hold no blanks"));
}

struct Fault {
    const char* line;
    const char* reason;
};

class Vs3Fault : public ReadVs3, public ::testing::WithParamInterface<Fault> {};

TEST_P(Vs3Fault, IsToldWithFileLineAndReason) {
    const std::string text = kVertices + kFloor + GetParam().line + "\n";

    EXPECT_EQ(error_of(text), std::string("room.vs3: line 12: ") + GetParam().reason);
}

INSTANTIATE_TEST_SUITE_P(
    All, Vs3Fault,
    ::testing::Values(
        Fault{"Q 2", "begins with none of T, C, F, V, S, N, O and E"},
        Fault{"F 2", "format \"2\" is neither 3 nor 3a"}, Fault{"F", "the format is missing"},
        Fault{"C eps=small", "\"small\" is no number"}, Fault{"C eps", "a number is missing"},
        Fault{"C size=1", "control \"size\" is not known"},
        Fault{"V 11 0 0 0", "vertex 11 is out of sequence"}, Fault{"V 10 0 0", "the z is missing"},
        Fault{"V 10 0 0 nan", "\"nan\" is not finite"},
        Fault{"V 10 0 0 1e999", "\"1e999\" is out of range"},
        Fault{"V x 0 0 1", "\"x\" is no number"},
        Fault{"S 3 1 2 3 4 0 0 0.9 a", "surface 3 is out of sequence"},
        Fault{"S 2 1 2 3 10 0 0 0.9 a", "vertex 10 is out of range, the lines above hold 9"},
        Fault{"S 2 0 2 3 4 0 0 0.9 a", "vertex 0 is out of range, the lines above hold 9"},
        Fault{"S 2 1 2", "the vertex is missing"},
        Fault{"S 2 1 2 3 4 0 0", "the emittance is missing"},
        Fault{"S 2 1 2 3 4 0 0 0.9", "the name is missing"},
        Fault{"S 2 1 2 3 4 0 0 1.5 a", "emittance 1.50 is not within 0 and 1"},
        Fault{"S 2 1 2 3 4 0 0 -0.1 a", "emittance -0.10 is not within 0 and 1"},
        Fault{"S 2 1 2 1 2 0 0 0.9 a", "the surface has no area"},
        Fault{"S 2 1 1 2 2 0 0 0.9 a", "the surface has no area"},
        Fault{"S 2 5 6 7 8 2 0 0.9 a", "base surface 2 does not stand before"},
        Fault{"S 2 5 6 7 8 -1 0 0.9 a", "base surface -1 does not stand before"},
        Fault{"S 2 5 6 7 8 0 2 0.9 a", "surface 2 to combine with does not stand before"},
        Fault{"S 2 1 2 9 0 1 0 0.9 a", "does not lie in the plane of its base surface"},
        Fault{"S 2 8 7 6 5 1 0 0.9 a", "must face as its base surface does"},
        Fault{"N 2 5 6 7 8 1 0 0.9 a", "must face its base surface"},
        Fault{"N 2 5 6 7 8 0 0 0.9 a", "a null surface needs a base surface"},
        Fault{"M 2 8 7 6 5 1 0 0.9 a", "masking surfaces (M) are not read"},
        Fault{"X 1 2 3", "coordinate transformations (X) are not read"}));

TEST_F(ReadVs3, ANameOf1001BytesIsRefused) {
    const std::string name(1001, 'x');

    EXPECT_EQ(error_of(kVertices + "S 1 1 2 3 4 0 0 0.9 " + name + "\n"),
              "room.vs3: surface \"" + name.substr(0, 200) +
                  "...\": its name has 1001 bytes, more than the 1000 that are read");
    EXPECT_EQ(error_of(kVertices + "S 1 1 2 3 4 0 0 0.9 " + name.substr(1) + "\n"), "");
}

TEST_F(ReadVs3, ASubsurfaceMustLieWithinItsBase) {
    EXPECT_EQ(error_of(kVertices + "S 1 5 6 7 8 0 0 0.9 rug\nS 2 1 2 3 4 1 0 0.9 floor\n"),
              "room.vs3: line 12: reaches beyond its base surface");
}

TEST_F(ReadVs3, ObstructionsStandLast) {
    EXPECT_EQ(error_of(kVertices + "O 1 1 2 3 4\nS 2 1 2 9 0 0 0 0.9 a\n"),
              "room.vs3: line 12: surface 2 must stand before the obstructions");
}

TEST_F(ReadVs3, CombinationsAreNotChained) {
    EXPECT_EQ(error_of(kVertices + kFloor + "S 2 1 2 9 0 0 1 0.9 a\nS 3 1 2 9 0 0 2 0.9 b\n"),
              "room.vs3: line 13: surface 2 is itself combined with another");
}

TEST_F(ReadVs3, TheFormatStandsBeforeTheSurfaces) {
    EXPECT_EQ(error_of("V 1 0 0 0\nS 1 1 1 1 1 0 0 0.9 a\n"),
              "room.vs3: line 2: an F line must stand before the surfaces");
}

TEST_F(ReadVs3, ABlastSurfaceIsWhole) {
    EXPECT_EQ(error_of("F 3a\nS 1 P 0 0 0.9 a\n"),
              "room.vs3: line 2: shape \"P\" is none of R, Q and T");
    EXPECT_EQ(error_of("F 3a\nS 1 R 0 0 0.9 a\n"),
              "room.vs3: line 2: the surface's plane is missing");
    EXPECT_EQ(error_of("F 3a\nS 1 R 0 0 0.9 a\n0 0 0 0 90 1\nEnd\n"),
              "room.vs3: line 4: the height is missing");
}

TEST_F(ReadVs3, AFileWithoutSurfacesIsRefused) {
    EXPECT_EQ(error_of("T nothing\nEnd\n"), "room.vs3: holds no faces");
}

}  // namespace
}  // namespace hemirad::test::read_vs3_test
