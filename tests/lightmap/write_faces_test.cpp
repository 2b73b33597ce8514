#include "lightmap/write_faces.h"

#include "errors.h"
#include "lightmap/support.h"

namespace hemirad::write_faces_test {
namespace {

class WriteFaces : public InFolder {};

/// A rectangle of 2 x 1 m and a triangle without area.
Scene pencil_scene() {
    Scene scene;
    scene.bands = {"R", "G", "B"};
    scene.positions = {{0, 0, 3}, {2, 0, 3}, {2, 1, 3}, {0, 1, 3}};
    scene.faces = {{{0, 1, 1}, 1, 1}, {{0, 1, 2, 3}, 0, 0}};
    scene.materials = {{"white", {}, {}}, {"say \"red\"", {}, {}}};
    scene.objects = {"floor, ground", "sliver"};
    return scene;
}

/// The rectangle in two patches, of which the second is three times the first.
Mesh pencil_mesh() {
    Mesh mesh;
    mesh.fragments = {{1, 0, 0.5}, {1, 1, 1.5}};
    return mesh;
}

Solution pencil_solution() {
    Solution solution;
    solution.bands = {"R", "G", "B"};
    solution.irradiance = {{4, 8}, {0, 0}, {1.0 / 3, 1.0 / 3}};
    solution.radiosity = {{2, 4}, {1e-7, 1e-7}, {123456789.4, 123456789.4}};
    return solution;
}

TEST_F(WriteFaces, OneRowAnInputPolygonWithAreaMeansDroppedOnesEmpty) {
    write_faces(file("a.csv"), pencil_scene(), pencil_mesh(), pencil_solution());

    EXPECT_EQ(bytes_of(file("a.csv")),
              "face,object,material,area,cx,cy,cz,irradiance.R,irradiance.G,irradiance.B,"
              "radiosity.R,radiosity.G,radiosity.B\n"
              "0,sliver,\"say \"\"red\"\"\",,,,,,,,,,\n"
              "1,\"floor, ground\",white,2,1,0.5,3,7,0,0.333333333,3.5,1e-07,123456789\n");
}

TEST_F(WriteFaces, PartsOfTheLightHaveColumnsOfTheirOwn) {
    Solution solution = pencil_solution();
    solution.bands = {"Y"};
    solution.irradiance.resize(1);
    solution.radiosity.resize(1);
    solution.parts = {{SolutionPart::Kind::light, "a,b", {{0, 4}}, {{1, 1}}, {}},
                      {SolutionPart::Kind::direct, "", {{4, 0}}, {{2, 2}}, {}}};

    write_faces(file("a.csv"), pencil_scene(), pencil_mesh(), solution);

    EXPECT_EQ(bytes_of(file("a.csv")),
              "face,object,material,area,cx,cy,cz,irradiance.Y,radiosity.Y,"
              "light.a%2Cb.irradiance.Y,light.a%2Cb.radiosity.Y,direct.irradiance.Y,"
              "direct.radiosity.Y\n"
              "0,sliver,\"say \"\"red\"\"\",,,,,,,,,,\n"
              "1,\"floor, ground\",white,2,1,0.5,3,7,3.5,3,1,1,2\n");
}

TEST_F(WriteFaces, TheCentroidOfAConcavePolygonIsThatOfItsArea) {
    Scene scene = pencil_scene();
    scene.positions = {{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {0, 3, 0}};  // notched towards the origin
    scene.faces = {{{1, 2, 3, 0}, 0, 0}};
    Mesh mesh;
    mesh.fragments = {{0, 0, 3.0}};

    write_faces(file("a.csv"), scene, mesh, pencil_solution());

    // Triangles (0, 0), (3, 0), (1, 1) and (0, 0), (1, 1), (0, 3), of area 1.5 each.
    EXPECT_NE(
        bytes_of(file("a.csv")).find("\n0,\"floor, ground\",white,3,0.833333333,0.833333333,0,"),
        std::string::npos);
}

TEST_F(WriteFaces, AFullDiskIsTold) {
    EXPECT_EQ(message_of<OutputError>([] {
                  write_faces("/dev/full", pencil_scene(), pencil_mesh(), pencil_solution());
              }),
              "/dev/full: No space left on device");
}

}  // namespace
}  // namespace hemirad::write_faces_test
