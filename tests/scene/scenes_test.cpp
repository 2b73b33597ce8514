#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <utility>

#include "scene/read_scene.h"
#include "scene/scene_folder.h"

namespace hemirad::test::scenes_test {
namespace {

using ::testing::DoubleEq;
using ::testing::Each;
using ::testing::IsEmpty;

const std::filesystem::path kScenes = HEMI_SCENES;

void generate(const SceneFolder& folder, const std::string& arguments) {
    const std::string command = std::string("'") + HEMI_PYTHON + "' -B '" +
                                (kScenes / "generate.py").string() + "' '" +
                                folder.path().string() + "' " + arguments;
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
}

std::string bytes_at(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

using Point = std::array<double, 3>;

/// Edges that are not shared by exactly two faces of opposite direction; equal positions are one.
std::size_t open_edges(const Scene& scene) {
    std::map<std::pair<Point, Point>, int> count;
    const auto point = [&](std::uint32_t vertex) {
        const auto& p = scene.positions[vertex];
        return Point{p.x, p.y, p.z};
    };
    for (const auto& face : scene.faces) {
        for (std::size_t i = 0; i < face.vertices.size(); ++i) {
            const auto next = face.vertices[(i + 1) % face.vertices.size()];
            ++count[{point(face.vertices[i]), point(next)}];
        }
    }
    std::size_t open = 0;
    for (const auto& [edge, times] : count) {
        const auto reverse = count.find({edge.second, edge.first});
        open += times != 1 || reverse == count.end() || reverse->second != 1;
    }
    return open;
}

/// Six times the volume inside outward fronts; a room, with its fronts inwards, counts negative.
double signed_volume(const Scene& scene) {
    double volume = 0;
    for (const auto& face : scene.faces) {
        for (std::size_t i = 2; i < face.vertices.size(); ++i) {
            const auto& a = scene.positions[face.vertices[0]];
            const auto& b = scene.positions[face.vertices[i - 1]];
            const auto& c = scene.positions[face.vertices[i]];
            volume += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) +
                      a.z * (b.x * c.y - b.y * c.x);
        }
    }
    return volume / 6;
}

TEST(Scenes, AreWhatTheGeneratorWrites) {
    const SceneFolder folder;
    generate(folder, "");

    int compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const auto name = entry.path().filename();
        EXPECT_TRUE(bytes_at(entry.path()) == bytes_at(kScenes / name)) << name;
        ++compared;
    }

    EXPECT_EQ(compared, 12);
}

class CommittedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(CommittedScene, IsReadWithoutAWarning) {
    const Scene scene = read_scene(kScenes / GetParam());

    EXPECT_THAT(scene.warnings, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, CommittedScene,
                         ::testing::Values("cornell.gltf", "furnace.obj", "squares.obj",
                                           "screen.vs3", "lroom.obj", "hall2k.obj", "hall14k.obj"));

class ClosedScene : public ::testing::TestWithParam<const char*> {};

TEST_P(ClosedScene, HasNoOpenEdge) { EXPECT_EQ(open_edges(read_scene(kScenes / GetParam())), 0u); }

TEST_P(ClosedScene, LooksInwards) { EXPECT_LT(signed_volume(read_scene(kScenes / GetParam())), 0); }

INSTANTIATE_TEST_SUITE_P(All, ClosedScene,
                         ::testing::Values("furnace.obj", "lroom.obj", "hall2k.obj",
                                           "hall14k.obj"));

TEST(Scenes, TheFurnaceTakesAReflectance) {
    const SceneFolder folder;
    generate(folder, "furnace --rho 0.99");

    const Scene scene = read_scene(folder.path() / "furnace.obj");

    EXPECT_EQ(scene.faces.size(), 6u);
    EXPECT_NEAR(signed_volume(scene), -1, 1e-15);
    EXPECT_THAT(scene.materials.at(0).reflectance, Each(DoubleEq(0.99)));
    EXPECT_THAT(scene.materials.at(0).emission, Each(1));
}

TEST(Scenes, TheFurnishedHallIsClosedAtEverySize) {
    for (const int quads : {1000, 15000, 40000}) {
        const SceneFolder folder;
        generate(folder, "furnished --quads " + std::to_string(quads));

        const Scene scene = read_scene(folder.path() / "furnished.obj");

        EXPECT_LE(scene.faces.size(), static_cast<std::size_t>(quads));
        EXPECT_GE(scene.faces.size(), static_cast<std::size_t>(0.85 * quads));
        EXPECT_EQ(open_edges(scene), 0u);
        for (const auto& face : scene.faces) ASSERT_EQ(face.vertices.size(), 4u);
    }
}

TEST(Scenes, TheSquaresFaceEachOther) {
    const Scene scene = read_scene(kScenes / "squares.obj");

    // Seen from the origin in the lower one, only the upper one spans volume: 1 / 3 of a cube,
    // negative as its front looks to the origin.
    EXPECT_NEAR(signed_volume(scene), -1.0 / 3, 1e-15);
    EXPECT_THAT(scene.objects, ::testing::ElementsAre("lower", "upper"));
}

}  // namespace
}  // namespace hemirad::test::scenes_test
