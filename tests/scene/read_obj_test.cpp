#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/read_scene.h"
#include "scene/scene_folder.h"

namespace hemirad::test::read_obj_test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class ReadObj : public ::testing::Test {
  protected:
    SceneFolder folder;
};

TEST_F(ReadObj, KeepsPolygonsAsTheyAre) {
    const Scene scene = folder.read("a.obj", kSquare + "v 0 2 0\nf 1 2 3 5 4\nf 1 2 3\n");

    ASSERT_EQ(scene.faces.size(), 2u);
    EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 4, 3));
    EXPECT_THAT(scene.faces[1].vertices, ElementsAre(0, 1, 2));
    EXPECT_THAT(scene.bands, ElementsAre("R", "G", "B"));
    EXPECT_EQ(scene.file, "a.obj");
}

TEST_F(ReadObj, ReadsAPolygonOfAThousandCorners) {
    std::string text, face = "f";
    for (int i = 1; i <= 1000; ++i) {
        text += "v " + std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
        face += " " + std::to_string(i);
    }

    const Scene scene = folder.read("a.obj", text + face);

    EXPECT_EQ(scene.faces.at(0).vertices.size(), 1000u);
}

TEST_F(ReadObj, ReadsCoordinatesToTheLastBitOfADouble) {
    const Scene scene =
        folder.read("a.obj", "v 0.5528 +1e-3 -1234567.8901234567\nv .1 3. 1E5\nv 0 0 0\nf 1 2 3\n");

    EXPECT_EQ(scene.positions[0].x, 0.5528);
    EXPECT_EQ(scene.positions[0].y, 1e-3);
    EXPECT_EQ(scene.positions[0].z, -1234567.8901234567);
    EXPECT_EQ(scene.positions[1].x, 0.1);
    EXPECT_EQ(scene.positions[1].y, 3.0);
    EXPECT_EQ(scene.positions[1].z, 1e5);
}

TEST_F(ReadObj, ReadsCornersWithTextureAndNormalIndices) {
    const Scene scene = folder.read("a.obj", kSquare + "vt 0 0\nvn 0 0 1\nf 1/1 2/1/1 3//1\n");

    EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2));
}

TEST_F(ReadObj, CountsNegativeIndicesBackFromTheirLine) {
    const Scene scene = folder.read("a.obj", kSquare + "f -4 -3 -2\nv 9 9 9\nf -2 -3 -5\n");

    EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2));
    EXPECT_THAT(scene.faces[1].vertices, ElementsAre(3, 2, 0));
}

TEST_F(ReadObj, NamesFacesAfterTheirObjectOrGroup) {
    const Scene scene = folder.read("a.obj", kSquare +
                                                 "f 1 2 3\n"
                                                 "o table\nf 1 2 3\n"
                                                 "g top left\nf 1 2 3\n"
                                                 "g legs\nf 1 2 3\n"
                                                 "g top left\nf 1 2 3\n"
                                                 "o chair\ng legs\nf 1 2 3\n"
                                                 "o lamp\nf 1 2 3\n");

    EXPECT_THAT(scene.objects, ElementsAre("default", "table", "top left", "legs", "legs", "lamp"));
    std::vector<std::uint32_t> objects;
    for (const auto& face : scene.faces) objects.push_back(face.object);
    EXPECT_THAT(objects, ElementsAre(0, 1, 2, 3, 2, 4, 5));
}

TEST_F(ReadObj, TakesKdAsReflectanceAndKeAsRadiance) {
    folder.write("a.mtl", "newmtl lamp \nKd 0.1 0.2 0.3\nKe 4 5 6\nnewmtl wall\nKd 1 0.5 0\n");

    const Scene scene = folder.read(
        "a.obj", "mtllib a.mtl\n" + kSquare + "usemtl wall\nf 1 2 3\nusemtl lamp\nf 1 2 4\n");

    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[0].name, "wall");
    EXPECT_THAT(scene.materials[0].reflectance, ElementsAre(1, 0.5, 0));
    EXPECT_THAT(scene.materials[0].emission, ElementsAre(0, 0, 0));
    EXPECT_EQ(scene.materials[1].name, "lamp");
    EXPECT_THAT(scene.materials[1].reflectance,
                ElementsAre(DoubleEq(0.1), DoubleEq(0.2), DoubleEq(0.3)));
    EXPECT_THAT(scene.materials[1].emission, ElementsAre(4, 5, 6));
    EXPECT_EQ(scene.faces[1].material, 1u);
    EXPECT_FALSE(scene.materials[0].double_sided);
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ReadObj, ReadsEveryLibraryThatALineNames) {
    folder.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\n");
    folder.write("sub/b.mtl", "newmtl b\nKd 0.2 0.2 0.2\n");

    const Scene scene =
        folder.read("a.obj", "mtllib a.mtl sub/b.mtl\n" + kSquare + "usemtl b\nf 1 2 3\n");

    EXPECT_THAT(scene.materials[0].reflectance, ElementsAre(0.2, 0.2, 0.2));
}

TEST_F(ReadObj, WarnsOfAMissingLibraryAndTakesGrey) {
    const Scene scene =
        folder.read("a.obj", "mtllib no.mtl\n" + kSquare + "usemtl red\nf 1 2 3\nf 1 2 4\n");

    EXPECT_EQ(scene.materials.at(0).name, "red");
    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(0.5, 0.5, 0.5));
    EXPECT_THAT(scene.warnings,
                ElementsAre("a.obj: mtllib \"no.mtl\": does not exist",
                            "a.obj: material \"red\": is not defined, grey of reflectance 0.50 "
                            "stands in"));
}

TEST_F(ReadObj, WarnsOfALibraryWhoseNameNoFileCanHave) {
    const std::string name(256, 'a');

    const Scene scene = folder.read("a.obj", "mtllib " + name + "\n" + kSquare + "f 1 2 3\n");

    EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("mtllib"), HasSubstr("does not exist"))));
}

TEST_F(ReadObj, ReadsALibraryOnceHoweverOftenItIsNamed) {
    const Scene scene = folder.read(
        "a.obj", "mtllib no.mtl ./no.mtl\nmtllib b/../no.mtl\n" + kSquare + "f 1 2 3\n");

    EXPECT_EQ(scene.warnings.size(), 2u) << "one of the library, one of the face";
}

TEST_F(ReadObj, WarnsOfFacesWithoutMaterialAndTakesGrey) {
    folder.write("a.mtl", "Kd 0.9 0.9 0.9\n");

    const Scene scene = folder.read("a.obj", "mtllib a.mtl\n" + kSquare + "f 1 2 3\n");

    EXPECT_EQ(scene.materials.at(0).name, "default");
    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(0.5, 0.5, 0.5));
    EXPECT_THAT(scene.warnings, ElementsAre("a.obj: faces without a material: grey of reflectance "
                                            "0.50 stands in"));
}

TEST_F(ReadObj, WarnsOfATextureThatItDoesNotRead) {
    folder.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\nmap_Kd wood.png\n");

    const Scene scene = folder.read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n");

    EXPECT_THAT(scene.warnings,
                ElementsAre("a.obj: material \"a\": map_Kd is not read, Kd stands alone"));
}

TEST_F(ReadObj, WarnsOfATextureOfEmissionAndOfTransparency) {
    folder.write("a.mtl", "newmtl a\nmap_Ke x.png\nd 0.1\nnewmtl b\nTr 0.5\nnewmtl c\nd 1\nTr 0\n");

    const Scene scene =
        folder.read("a.obj", "mtllib a.mtl\n" + kSquare +
                                 "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n");

    EXPECT_THAT(
        scene.warnings,
        ElementsAre("a.obj: material \"a\": map_Ke is not read, Ke stands alone",
                    "a.obj: material \"a\": d and Tr are not read, the material is opaque",
                    "a.obj: material \"b\": d and Tr are not read, the material is opaque"));
}

TEST_F(ReadObj, TakesEveryLineEndAndContinuedLines) {
    const Scene scene = folder.read("a.OBJ",
                                    "# C:\\\r\nv 0 0 0\r\nv 1 0 0\rv 1 1 0\n\tv 0 \\\r\n1 0\n"
                                    "f 1 2 \\\n 3 \\\n 4");

    EXPECT_EQ(scene.positions.size(), 4u);
    EXPECT_THAT(scene.faces[0].vertices, ElementsAre(0, 1, 2, 3));
}

TEST_F(ReadObj, SkipsAByteOrderMark) {
    const std::string mark = "\xef\xbb\xbf";
    folder.write("a.mtl", mark + "newmtl a\nKd 0.1 0.1 0.1\n");

    const Scene scene =
        folder.read("a.obj", mark + "v 9 9 9\nmtllib a.mtl\n" + kSquare + "usemtl a\nf 2 3 4\n");

    EXPECT_EQ(scene.positions.size(), 5u);
    EXPECT_EQ(scene.positions[scene.faces.at(0).vertices[0]], glm::dvec3(0, 0, 0));
    EXPECT_EQ(scene.materials.at(0).name, "a");
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ReadObj, ReadsALibraryWhoseNameHasBlanks) {
    folder.write("sub/my mat.mtl", "newmtl a\nKd 0.1 0.1 0.1\n");
    folder.write("b.mtl", "newmtl b\nKd 0.2 0.2 0.2\n");

    const Scene scene =
        folder.read("a.obj", "mtllib sub/my mat.mtl \nmtllib sub/my\\ mat.mtl b.mtl\n" + kSquare +
                                 "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");

    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(0.1, 0.1, 0.1));
    EXPECT_THAT(scene.materials.at(1).reflectance, ElementsAre(0.2, 0.2, 0.2));
    EXPECT_THAT(scene.warnings, IsEmpty());
}

TEST_F(ReadObj, EndsALineAtAComment) {
    folder.write("a.mtl", "newmtl a # b\nKd 0.1 0.1 0.1 # grey\nKe 2\t#\n");

    const Scene scene = folder.read(
        "a.obj", "mtllib a.mtl # c\n" + kSquare + "f 1 2 3\t# 4 \\\nusemtl a\nf 1 2 3 #\n");

    EXPECT_THAT(scene.faces.at(0).vertices, ElementsAre(0, 1, 2));
    EXPECT_THAT(scene.faces.at(1).vertices, ElementsAre(0, 1, 2));
    EXPECT_EQ(scene.materials.at(1).name, "a");
    EXPECT_THAT(scene.materials.at(1).reflectance, ElementsAre(0.1, 0.1, 0.1));
    EXPECT_THAT(scene.materials.at(1).emission, ElementsAre(2, 2, 2));
}

TEST_F(ReadObj, LooksForAMaterialWithoutItsComment) {
    folder.write("a.mtl", "newmtl a\nKd 0.1 0.1 0.1\n");

    const Scene scene = folder.read(
        "a.obj", "mtllib a.mtl\n" + kSquare + "usemtl a # wood\nf 1 2 3\nusemtl a\nf 1 2 3\n");

    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].name, "a");
    EXPECT_THAT(scene.warnings, IsEmpty());
}

/// Names as 3ds Max gives them.
TEST_F(ReadObj, KeepsNumbersInNames) {
    folder.write("a.mtl",
                 "newmtl Material #1\nKd 0.1 0.1 0.1\nnewmtl Material #2\nKd 0.2 0.2 0.2\n");

    const Scene scene = folder.read(
        "a.obj", "mtllib a.mtl\n" + kSquare +
                     "o Box #1\nusemtl Material #2\nf 1 2 3\nusemtl Material #3\nf 1 2 3\n");

    EXPECT_THAT(scene.objects, ElementsAre("Box #1"));
    EXPECT_EQ(scene.materials.at(0).name, "Material #2");
    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(0.2, 0.2, 0.2));
    EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("\"Material #3\": is not defined")));
}

TEST_F(ReadObj, TakesOneNumberOfAColourForAllThree) {
    folder.write("a.mtl", "newmtl a\n Kd .5\nKe\t1\n");

    const Scene scene = folder.read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n");

    EXPECT_THAT(scene.materials.at(0).reflectance, ElementsAre(0.5, 0.5, 0.5));
    EXPECT_THAT(scene.materials.at(0).emission, ElementsAre(1, 1, 1));
}

TEST_F(ReadObj, EscapesControlCharactersInNames) {
    const Scene scene =
        folder.read("a.obj", "o a\x1b[31mb\nusemtl c\x07\n" + kSquare + "f 1 2 3\n");

    EXPECT_THAT(scene.objects, ElementsAre("a\\x1b[31mb"));
    EXPECT_EQ(scene.materials[0].name, "c\\x07");
    EXPECT_THAT(scene.warnings.at(0), HasSubstr("material \"c\\x07\""));
}

const std::string kTooLong = "...\": its name has 1001 bytes, more than the 1000 that are read";

std::string face_of(int corners) {
    std::string line = "f";
    for (int i = 0; i < corners; ++i) line += " 1";
    return line + '\n';
}

struct BadObj {
    const char* name;
    std::string text, error;
};

class ReadBadObj : public ::testing::TestWithParam<BadObj> {};

TEST_P(ReadBadObj, SaysWhatIsWrongInOneLine) {
    const SceneFolder folder;
    folder.write("bad.mtl", GetParam().text);

    const std::string text = GetParam().text.starts_with("newmtl")
                                 ? "mtllib bad.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n"
                                 : GetParam().text;

    EXPECT_EQ(folder.error_of("bad.obj", text), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    Files, ReadBadObj,
    ::testing::Values(
        BadObj{"Empty", "", "bad.obj: is empty"},
        BadObj{"NoFaces", kSquare, "bad.obj: holds no faces"},
        BadObj{"NotObj", "\x89PNG\r\n\x1a\n", "bad.obj: holds no faces"},
        BadObj{"IndexTooLarge", kSquare + "f 1 2 5\n",
               "bad.obj: line 5: vertex 5 is out of range, the file holds 4"},
        BadObj{"IndexTooSmall", kSquare + "\nf 1 2 -5\n",
               "bad.obj: line 6: vertex -5 is out of range, the file holds 4"},
        BadObj{"IndexZero", kSquare + "f 0 1 2\n", "bad.obj: line 5: index 0, the first is 1"},
        BadObj{"IndexHuge", kSquare + "f 1 2 4294967297\n",
               "bad.obj: line 5: \"4294967297\" is out of range"},
        BadObj{"IndexIsText", kSquare + "f 1 2 x\n", "bad.obj: line 5: \"x\" is no number"},
        BadObj{"IndexIsFraction", kSquare + "f 1 2 3.5\n", "bad.obj: line 5: \"3.5\" is no number"},
        BadObj{"FourIndices", kSquare + "f 1 2 3/1/1/1\n",
               "bad.obj: line 5: a corner has more than three indices"},
        BadObj{"TooManyCorners", kSquare + face_of(10001),
               "bad.obj: line 5: a face has 10001 corners, more than the 10000 that are read"},
        BadObj{"TooManyCornersTogether",
               kSquare + face_of(10000) + face_of(10000) + face_of(10000) + face_of(8000),
               "bad.obj: OBJ: its faces have too many corners: squared and added up 364000000, "
               "more than the 307604000 that are read of 76040 bytes"},
        BadObj{"TwoCorners", kSquare + "f 1 2\n", "bad.obj: line 5: a face needs three corners"},
        BadObj{"NanCoordinate", "v 0 0 nan\n", "bad.obj: line 1: \"nan\" is not finite"},
        BadObj{"InfiniteCoordinate", "v 0 -inf 0\n", "bad.obj: line 1: \"-inf\" is not finite"},
        BadObj{"HugeCoordinate", "v 1e999 0 0\n", "bad.obj: line 1: \"1e999\" is out of range"},
        BadObj{"CoordinateIsText", "v 0 0 \x1b\n", "bad.obj: line 1: \"\\x1b\" is no number"},
        BadObj{"CoordinateMissing", "v 0 0\n", "bad.obj: line 1: a number is missing"},
        BadObj{"LongObject", "o " + std::string(1001, 'x') + "\n",
               "bad.obj: object \"" + std::string(200, 'x') + kTooLong},
        BadObj{"LongGroup", "g " + std::string(500, 'x') + " " + std::string(500, 'x') + "\n",
               "bad.obj: group \"" + std::string(200, 'x') + kTooLong},
        BadObj{"LongMaterial", "usemtl " + std::string(1001, 'x') + "\n",
               "bad.obj: material \"" + std::string(200, 'x') + kTooLong},
        BadObj{"LibraryOutside", "mtllib ../a.mtl\n",
               "bad.obj: mtllib \"../a.mtl\": must be a file in the scene's folder"},
        BadObj{"LibraryAbsolute", "mtllib /etc/passwd\n",
               "bad.obj: mtllib \"/etc/passwd\": must be a file in the scene's folder"},
        BadObj{"ReflectanceAboveOne", "newmtl m\nKd 1 1.2 1\n",
               "bad.obj: material \"m\": reflectance 1.20 is above 1"},
        BadObj{"ReflectanceJustAboveOne", "newmtl m\nKd 1 1.00001 1\n",
               "bad.obj: material \"m\": reflectance 1.00001 is above 1"},
        BadObj{"ReflectanceNegative", "newmtl m\nKd -0.1 0 0\n",
               "bad.obj: material \"m\": reflectance -0.10 is below 0"},
        BadObj{"ReflectanceNan", "newmtl m\nKd nan 0 0\n",
               "bad.mtl: line 2: \"nan\" is not finite"},
        BadObj{"EmissionNegative", "newmtl m\nKe 0 0 -3\n",
               "bad.obj: material \"m\": emission -3.00 is below 0"},
        BadObj{"EmissionInfinite", "newmtl m\nKe inf 0 0\n",
               "bad.mtl: line 2: \"inf\" is not finite"},
        BadObj{"ReflectanceOfTwoNumbers", "newmtl m\nKd 0.5 0.5 # 1\n",
               "bad.mtl: line 2: a number is missing"},
        BadObj{"LibraryWithBlanksOutside", "mtllib my mat/../../a.mtl\n",
               "bad.obj: mtllib \"mat/../../a.mtl\": must be a file in the scene's folder"},
        BadObj{"ReflectanceIsSpectralFile", "newmtl m\nKd spectral red.rfl\n",
               "bad.mtl: line 2: \"spectral\" is no number"}),
    [](const auto& test) { return test.param.name; });

TEST_F(ReadObj, RefusesWhatIsNoFile) {
    EXPECT_THAT(folder.error_of(folder.path() / "no.obj"), HasSubstr("no.obj: does not exist"));
    EXPECT_THAT(folder.error_of(folder.path()), HasSubstr(": is a folder, not a scene file"));
    EXPECT_EQ(folder.error_of("room.ply", "ply\n"),
              "room.ply: is neither .gltf, .glb, .obj nor .vs3");
}

TEST_F(ReadObj, RefusesALibraryThatIsAFolder) {
    folder.write("lib/a.mtl", "");

    const std::string error = folder.error_of("a.obj", "mtllib lib\n" + kSquare + "f 1 2 3\n");

    EXPECT_THAT(error, HasSubstr("lib: is a folder"));
}

}  // namespace
}  // namespace hemirad::test::read_obj_test
