#include <gtest/gtest.h>

#include "solver/nothing_escapes.h"
#include "solver/support.h"

// Counts + escaped = proxels in the disk, and none escapes from a closed scene: no proxel is lost
// between two patches that share an edge, or a part of one (T-junctions).
namespace hemirad::test::closure_test {
namespace {

TEST(Closure, NothingEscapesFromTheFurnace) {
    for (const std::uint32_t resolution : {64u, 100u, 256u})
        for (const double patch_size : {1.0, 0.5, 0.13})
            expect_nothing_escapes(meshed(scene_named("furnace.obj"), patch_size), resolution,
                                   patch_size < 0.2 ? 5 : 1);
}

TEST(Closure, NothingEscapesFromTheLRoom) {
    expect_nothing_escapes(meshed(scene_named("lroom.obj"), 0), 256, 3);
}

TEST(Closure, NothingEscapesFromTheSmallHall) {
    expect_nothing_escapes(meshed(scene_named("hall2k.obj"), 0), 256, 5);
}

TEST(Closure, NothingEscapesFromTheLargeHall) {
    expect_nothing_escapes(meshed(scene_named("hall14k.obj"), 0), 256, 97);
}

TEST(Closure, NothingEscapesThroughTJunctionsOfRotatedRooms) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> size(0.3, 1.5);
    for (int round = 0; round < 12; ++round) {
        const Scene scene = rotated(furnished_room(), random_rotation(random));
        expect_nothing_escapes(meshed(scene, size(random)), round % 2 == 0 ? 64 : 256, 2);
    }
}

// A block on the floor, turned against it, and one on that, cut what they stand on at any angle.
TEST(Closure, NothingEscapesWhereFloorsAreCutAlongBlocks) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    for (int round = 0; round < 8; ++round) {
        Scene scene = room_with_turned_blocks(any(random));
        if (round % 2 == 1) scene = rotated(std::move(scene), random_rotation(random));
        expect_nothing_escapes(meshed(scene, 0.2 + any(random)), round % 4 < 2 ? 64 : 256, 2);
    }
}

TEST(Closure, NothingEscapesFromARotatedHall) {
    std::mt19937 random(2);
    const Scene scene = rotated(scene_named("hall2k.obj"), random_rotation(random));
    expect_nothing_escapes(meshed(scene, 0.41), 256, 17);
}

TEST(Closure, NothingEscapesBetweenElementsOfARotatedRoom) {
    std::mt19937 random(3);
    for (const double element_size : {0.19, 0.31}) {
        const Scene scene = rotated(scene_named("lroom.obj"), random_rotation(random));
        Mesh mesh = build_mesh(scene, {.patch_size = 0.7, .element_size = element_size});
        mesh.shooters.clear();  // each looks for itself
        expect_nothing_escapes(mesh, 256, 7);
    }
}

TEST(Closure, NothingEscapesBetweenSplitElementsOfARotatedRoom) {
    std::mt19937 random(4);
    const Scene scene = rotated(scene_named("lroom.obj"), random_rotation(random));
    const MeshSettings settings{.patch_size = 0.7, .split_levels = 2};
    Mesh mesh = build_mesh(scene, settings);
    for (std::uint32_t level = 0; level < settings.split_levels; ++level) {
        std::vector<bool> split(mesh.patches.size());
        for (std::size_t i = 0; i < split.size(); ++i) split[i] = random() % 3 == 0;
        mesh = split_mesh(scene, settings, mesh, {split});
    }
    mesh.shooters.clear();  // each looks for itself
    expect_nothing_escapes(mesh, 256, 7);
}

TEST(Closure, IsExactForEveryShotOfAnOpenScene) {
    const Mesh mesh = meshed(scene_named("squares.obj"), 0.25);
    const auto device = mp1map::Device::open("");
    auto how = settings(64);
    how.shooter_samples = 2;
    ProgressiveSolver solver(mesh, how, device);

    solver.solve(go_on);

    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    EXPECT_GT(solver.solution().ledger[0].escaped, 0);
}

}  // namespace
}  // namespace hemirad::test::closure_test
