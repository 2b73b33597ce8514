#include "solver/dark_backs.h"

#include <gtest/gtest.h>

#include "scene/scenes_by_hand.h"
#include "solver/support.h"

namespace hemirad::test::dark_backs_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

/// Walls are of material 0, double-sided; what is added as material 1 is a lamp.
Scene walls(const Faces& faces) {
    Scene scene = scene_of(faces);
    scene.materials[0].double_sided = true;
    scene.materials.push_back({"lamp", {0.0}, {1.0}, false});
    return scene;
}

Faces closed_room() { return room({0, 0, 0}, {4, 4, 2}); }

void add_lamp(Scene& scene, const glm::dvec3& low) {
    for (const auto& face : solid_box(low, low + glm::dvec3(0.5))) add_face(scene, face, 1);
}

struct Backs {
    int with_chart = 0, without = 0;

    bool operator==(const Backs&) const = default;
};

Backs backs_left(const Scene& scene) {
    Mesh mesh = meshed(scene, 0.5, Backfaces::block);
    drop_dark_backs(mesh);
    Backs backs;
    for (const Surface& surface : mesh.surfaces) {
        const bool is_lamp = !mesh.materials[surface.material].double_sided;
        if (surface.is_back && !is_lamp) ++(surface.has_chart ? backs.with_chart : backs.without);
        EXPECT_TRUE(surface.is_back || surface.has_chart);
    }
    return backs;
}

TEST(DarkBacks, TheOutsideOfARoomNeedsNoChart) {
    Scene scene = walls(closed_room());
    add_lamp(scene, {1, 1, 1});

    EXPECT_EQ(backs_left(scene), (Backs{0, 6}));
}

TEST(DarkBacks, TheOutsideOfARoomThatIsOpenMayBeLit) {
    Faces faces = closed_room();
    faces.pop_back();
    Scene scene = walls(faces);
    add_lamp(scene, {1, 1, 1});

    EXPECT_EQ(backs_left(scene), (Backs{5, 0}));
}

TEST(DarkBacks, TheOutsideOfARoomThatALampShinesOnIsLit) {
    Scene scene = walls(closed_room());
    add_lamp(scene, {1, 1, 1});
    add_lamp(scene, {6, 1, 1});

    EXPECT_EQ(backs_left(scene), (Backs{6, 0}));
}

TEST(DarkBacks, AWallThatShinesToBothSidesIsALampOutside) {
    Scene scene = walls(closed_room());
    scene.materials[0].emission = {1.0};

    EXPECT_EQ(backs_left(scene), (Backs{6, 0}));
}

TEST(DarkBacks, BothSidesOfASheetInTheRoomAreLit) {
    Scene scene = walls(closed_room());
    add_lamp(scene, {1, 1, 1});
    add_face(scene, {{3, 1, 0.5}, {3, 3, 0.5}, {3, 3, 1.5}, {3, 1, 1.5}});

    EXPECT_EQ(backs_left(scene), (Backs{1, 6}));
}

}  // namespace
}  // namespace hemirad::test::dark_backs_test
