#include "scene/lights.h"

#include <gtest/gtest.h>

#include "scene/scenes_by_hand.h"

namespace hemirad::lights_test {
namespace {

using Names = std::vector<std::string>;

/// Squares side by side, each of an object and a material.
struct Square {
    std::uint32_t object, material;
};

Mesh squares(const std::vector<Square>& each) {
    Scene scene = empty_scene();
    scene.objects = {"floor", "left", "right", "left"};
    scene.materials = {grey(), {"warm", {0.5}, {1}, false}, {"cold", {0.5}, {2}, false}};
    for (std::size_t i = 0; i < each.size(); ++i)
        add_face(scene, rectangle(2.0 * double(i), 0, 2.0 * double(i) + 1, 1), each[i].material,
                 each[i].object);
    return mesh_of(scene, 10);
}

std::vector<std::uint32_t> lights_of_patches(const Mesh& mesh, const LightGroups& groups) {
    std::vector<std::uint32_t> lights;
    for (const Patch& patch : mesh.patches) lights.push_back(groups.of_surface[patch.surface]);
    return lights;
}

TEST(Lights, TogetherAreNotGrouped) {
    EXPECT_TRUE(group_lights(squares({{1, 1}, {2, 2}}), Lights::together).names.empty());
}

TEST(Lights, AreTheObjectsThatEmit) {
    const Mesh mesh = squares({{0, 0}, {2, 1}, {1, 1}, {1, 2}, {1, 0}});

    const auto groups = group_lights(mesh, Lights::separate);

    EXPECT_EQ(groups.names, (Names{"right", "left"}));
    EXPECT_EQ(lights_of_patches(mesh, groups),
              (std::vector<std::uint32_t>{kNoLight, 0, 1, 1, kNoLight}));
}

TEST(Lights, OfOneNameAreOne) {
    EXPECT_EQ(group_lights(squares({{1, 1}, {3, 1}, {2, 1}}), Lights::separate).names,
              (Names{"left", "right"}));
}

TEST(Lights, OfOneObjectAreItsMaterials) {
    EXPECT_EQ(group_lights(squares({{0, 0}, {1, 1}, {1, 2}}), Lights::separate).names,
              (Names{"warm", "cold"}));
}

TEST(Lights, AreMaterialsWhereThatIsAskedFor) {
    EXPECT_EQ(group_lights(squares({{1, 2}, {2, 2}, {2, 1}}), Lights::by_material).names,
              (Names{"cold", "warm"}));
}

}  // namespace
}  // namespace hemirad::lights_test
