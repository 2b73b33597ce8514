#include <gtest/gtest.h>

#include "scene/scene_folder.h"

namespace hemirad::test::quantum_test {
namespace {

class Quantum : public ::testing::Test {
  protected:
    double of_obj(const std::string& vertices) const {
        return folder.read("a.obj", vertices + "f 1 2 3\n").quantum;
    }
    double of_gltf(const Json& node) const {
        Json gltf = triangle_gltf();
        if (!node.is_null()) gltf["nodes"][0].update(node);
        return folder.read(gltf).quantum;
    }
    SceneFolder folder;
};

TEST_F(Quantum, IsHalfAUnitOfTheLastDecimal) {
    EXPECT_DOUBLE_EQ(of_obj("v 1000000.000 0 0\nv 1000002.345 0 0\nv 1000000.000 2.000 0\n"), 5e-4);
}

TEST_F(Quantum, CountsExponents) {
    EXPECT_DOUBLE_EQ(of_obj("v 1.0000000000e3 0 0\nv 1.0020001000e+3 0 0\nv 100000001e-5 0 0\n"),
                     5e-6);
}

TEST_F(Quantum, IsHalfAFloatUlpWhereDecimalsAreFew) {
    EXPECT_DOUBLE_EQ(of_obj("v 0 0 0\nv 1000 0 0\nv 0 2 0\n"), 1000 * 0x1p-24);
    EXPECT_DOUBLE_EQ(of_obj("v 0 0 0\nv 1 0 0\nv 0 .5 0\n"), 0x1p-24);
}

TEST_F(Quantum, IsThatOfTheCoarsestCoordinate) {
    EXPECT_DOUBLE_EQ(of_obj("v 0.000001 0 0\nv 16.25 0 0\nv 0.000001 2 0\n"), 16.25 * 0x1p-24);
}

TEST_F(Quantum, OfFloatsWrittenInFullIsTheirs) {
    EXPECT_DOUBLE_EQ(of_obj("v 0.100000001490116119384765625 0 0\nv 4.0000000000000 0 0\n"
                            "v 0 0.300000011920928955078125 0\n"),
                     4 * 0x1p-24);
    // 0.1 is no float.
    EXPECT_LT(of_obj("v 0.1000000000000 0 0\nv 4.0000000000000 0 0\n"
                     "v 0 0.300000011920928955078125 0\n"),
              1e-13);
}

TEST_F(Quantum, IsThatOfVerticesThatFacesUse) {
    const std::string used = "v 0 0 0\nv 1 0 0\nv 0 .5 0\n";
    EXPECT_DOUBLE_EQ(of_obj(used + "v 1000 0 0\n"), 0x1p-24);
    EXPECT_DOUBLE_EQ(of_obj("v 4.0000000000000 0 0\nv 0.100000001490116119384765625 0 0\n"
                            "v 0 0.300000011920928955078125 0\nv 0.1 0 0\n"),
                     4 * 0x1p-24);
    Json gltf = triangle_gltf();
    add_positions(gltf, {0, 0, 0, 1, 0, 0, 0, 1, 0, 1000, 0, 0});
    add_accessor(gltf, std::vector<std::uint32_t>{0, 1, 2}, "SCALAR", 5125, 3);
    gltf["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1;
    gltf["meshes"][0]["primitives"][0]["indices"] = 2;
    EXPECT_DOUBLE_EQ(folder.read(gltf).quantum, 0x1p-24);
}

TEST_F(Quantum, OfGltfIsTheLocalFloatsTimesTheScale) {
    EXPECT_DOUBLE_EQ(of_gltf({}), 0x1p-24);
    EXPECT_DOUBLE_EQ(of_gltf({{"scale", {1e-3, 1e-3, 1e-3}}}), 1e-3 * 0x1p-24);
}

TEST_F(Quantum, OfGltfDoesNotGrowFarFromTheOrigin) {
    EXPECT_DOUBLE_EQ(of_gltf({{"translation", {1e7, 1000.1, 0}}}), 0x1p-24);
}

TEST_F(Quantum, OfGltfCountsPlacesThatAreFloats) {
    const double at = double(1000.1f);
    EXPECT_DOUBLE_EQ(of_gltf({{"translation", {at, 0, 0}}}), 0x1p-24 + at * 0x1p-24);
}

TEST_F(Quantum, OfDecimetresFarAwayIsThatOfWhatWasChosen) {
    EXPECT_DOUBLE_EQ(of_obj("v 500000.0 4500000.0 100.0\nv 500001.0 4500000.0 100.3\n"
                            "v 500000.0 4500001.0 100.0\n"),
                     5e-4);
}

TEST_F(Quantum, OfView3dIsThatOfItsVertices) {
    const std::string surface = "S 1 1 2 3 0 0 0 0.5 one\nE\n";
    EXPECT_DOUBLE_EQ(
        folder.read("a.vs3", "F 3\nV 1 0. 0. 0.\nV 2 1000.123 0. 0.\nV 3 0. 1. 0.\n" + surface)
            .quantum,
        1000.123 * 0x1p-24);
    EXPECT_DOUBLE_EQ(
        folder.read("a.vs3", "F 3\nV 1 0. 0. 0.\nV 2 100000.123 0. 0.\nV 3 0. 1. 0.\n" + surface)
            .quantum,
        5e-4);
}

}  // namespace
}  // namespace hemirad::test::quantum_test
