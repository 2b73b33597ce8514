#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "errors.h"
#include "scene/scenes_by_hand.h"

namespace hemirad::mesh_extremes_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

/// A room of two units with a crate on its floor, an open sheet on a slant and a wall in two parts
/// of which one ends in the middle of an edge (a T-junction).
Faces furnished_room() {
    Faces faces = room({0, 0, 0}, {2, 1.5, 1});
    const auto wall = faces.back();
    faces.pop_back();
    const auto low = 0.5 * (wall[0] + wall[1]), high = 0.5 * (wall[2] + wall[3]);
    faces.push_back({wall[0], low, high, wall[3]});
    faces.push_back({low, wall[1], wall[2], high});
    for (const auto& face : solid_box({0.3, 0.4, 0}, {0.9, 0.7, 0.3})) faces.push_back(face);
    faces.push_back({{1.2, 0.3, 0.2}, {1.7, 0.3, 0.4}, {1.7, 0.9, 0.4}, {1.2, 0.9, 0.2}});
    return faces;
}

glm::dvec3 turned(const glm::dvec3& p) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const glm::dvec3 q(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
    return {q.x, c * q.y - s * q.z, s * q.y + c * q.z};
}

struct Placement {
    double size, offset;  ///< the offset in sizes
    bool is_turned;
};

/// As a file of doubles has it.
Scene placed(const Faces& faces, const Placement& at) {
    const glm::dvec3 shift = at.size * at.offset * glm::dvec3(1, -0.7, 0.4);
    Scene scene = scene_of(faces);
    for (auto& p : scene.positions) p = at.size * (at.is_turned ? turned(p) : p) + shift;
    scene.quantum = 0x1p-52 * at.size * (at.offset + 1);
    return scene;
}

using Topology = std::tuple<std::size_t, std::size_t, std::size_t, std::size_t, bool, std::size_t,
                            std::vector<std::array<std::uint32_t, 4>>>;

Topology topology(const Mesh& mesh) {
    std::set<std::uint32_t> planes;
    for (const Surface& surface : mesh.surfaces) planes.insert(surface.plane);
    std::vector<std::array<std::uint32_t, 4>> corners;
    for (const Patch& patch : mesh.patches) corners.push_back(patch.corners);
    return {mesh.vertices.size(), mesh.surfaces.size(), planes.size(), mesh.parts.size(),
            mesh.parts[0].closed, mesh.warnings.size(), corners};
}

class Extremes : public ::testing::TestWithParam<Placement> {};

TEST_P(Extremes, OfSizeAndPlaceLeaveTheMeshAsItIs) {
    const Placement at = GetParam();
    const Mesh plain = mesh_of(furnished_room(), 0.13, Backfaces::automatic);

    const Mesh mesh = mesh_of(placed(furnished_room(), at), 0.13 * at.size, Backfaces::automatic);

    EXPECT_TRUE(topology(mesh) == topology(plain))
        << mesh.patches.size() << " patches instead of " << plain.patches.size();
    EXPECT_NEAR(total_area(mesh) / (at.size * at.size) / total_area(plain), 1,
                0x1p-50 * (at.offset + 100));
}

std::vector<Placement> placements() {
    std::vector<Placement> all;
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6})
        for (const double offset : {0.0, 1.0, 1e3, 1e7})
            for (const bool is_turned : {false, true}) all.push_back({size, offset, is_turned});
    return all;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, ::testing::ValuesIn(placements()));

TEST(Weld, FollowsTheQuantumOfTheScene) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1), rectangle(0.2, 0, 1, 1)});
    scene.quantum = 1e-4;

    EXPECT_DOUBLE_EQ(mesh_of(scene, 10).weld, 4e-4);
}

TEST(Weld, IsNeverFinerThanTheDeviceTellsApart) {
    Scene scene = scene_of({rectangle(0, 0, 8, 1)});
    scene.quantum = 1e-17;

    EXPECT_DOUBLE_EQ(mesh_of(scene, 10).weld, 4 * 0x1p-29);
}

TEST(Weld, IsNeverFinerThanDoublesAreFarFromTheOrigin) {
    Scene scene = scene_of({rectangle(0x1p30, 0, 0x1p30 + 1, 1)});
    scene.quantum = 1e-17;

    EXPECT_DOUBLE_EQ(mesh_of(scene, 10).weld, 8 * 0x1p-52 * (0x1p30 + 1));
}

TEST(Weld, IgnoresPositionsThatNoFaceUses) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    const double weld = mesh_of(scene, 10).weld;
    scene.positions.push_back({1e9, 0, 0});

    EXPECT_EQ(mesh_of(scene, 10).weld, weld);
}

// A small face beside a position as far away as files may say.
TEST(Weld, DrawsNothingToPositionsThatNoFaceUses) {
    Scene scene = scene_of({rectangle(0, 0, 1e-6, 1e-6)});
    scene.positions.insert(scene.positions.begin(), {{1e-13, 0, 0}, {1e60, 0, 0}});
    for (auto& v : scene.faces[0].vertices) v += 2;
    const Mesh mesh = mesh_of(scene, 10);

    EXPECT_GT(mesh.weld, 1e-13);
    EXPECT_EQ(mesh.input.welded, 0u);
    EXPECT_EQ(mesh.vertices.front(), glm::dvec3(0));
}

TEST(Weld, CanBeChosen) {
    auto right = rectangle(1.001, 0, 2, 1);
    const Scene scene = scene_of({rectangle(0, 0, 1, 1), right});

    EXPECT_EQ(build_mesh(scene, {.patch_size = 10, .weld = 1e-4}).parts.size(), 2u);
    EXPECT_EQ(build_mesh(scene, {.patch_size = 10, .weld = 1e-2}).parts.size(), 1u);
}

TEST(Weld, KeepsATenthOfAMillimetreInAKilometreWhereAsked) {
    Faces faces = room({-500, -500, 0}, {500, 500, 100});
    for (const auto& face : solid_box({0, 0, 0}, {1e-4, 1e-4, 1e-4})) faces.push_back(face);

    const Mesh coarse = build_mesh(scene_of(faces), {.patch_size = 100});
    const Mesh fine = build_mesh(scene_of(faces), {.patch_size = 100, .weld = 1e-6});

    EXPECT_EQ(coarse.dropped_degenerate, 6u);
    EXPECT_EQ(fine.dropped_degenerate, 0u);
    EXPECT_TRUE(fine.closed);
}

TEST(Weld, OutOfRangeIsAnInputError) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1)});

    EXPECT_THROW(build_mesh(scene, {.patch_size = 10, .weld = 1e-12}), InputError);
    EXPECT_THROW(build_mesh(scene, {.patch_size = 10, .weld = 2}), InputError);
}

}  // namespace
}  // namespace hemirad::mesh_extremes_test
