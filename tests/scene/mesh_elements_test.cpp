#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <random>

#include "errors.h"
#include "scene/read_scene.h"
#include "scene/scenes_by_hand.h"

namespace hemirad::mesh_elements_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

Mesh two_levels(const Scene& scene, double patch_size, double element_size,
                Backfaces backfaces = Backfaces::automatic) {
    return build_mesh(
        scene, {.patch_size = patch_size, .element_size = element_size, .backfaces = backfaces});
}

Scene scene_named(const std::string& name) {
    return read_scene(std::filesystem::path(HEMI_SCENES) / name);
}

/// A concave floor, a triangle that shares its edge, and a wall of floats, all turned.
Scene turned_pieces(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> any;
    const auto turn =
        glm::normalize(glm::dquat(any(random), any(random), any(random), any(random)));
    Scene scene = scene_of({{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {2, 2, 0}, {1.1, 0.9, 0}, {0, 2, 0}},
                            {{3, 0, 0}, {4.3, 1.1, 0}, {3, 2, 0}},
                            {{0, 0, 0}, {0, 0, 1.7}, {3, 0, 1.7}, {3, 0, 0}}});
    for (glm::dvec3& p : scene.positions) p = glm::dvec3(glm::vec3(turn * p));
    return scene;
}

/// How far `p` lies outside the polygon of the shooter.
double outside(const Mesh& mesh, const Shooter& shooter, const glm::dvec3& p) {
    const Patch whole{shooter.corners, shooter.surface};
    const auto corners = corners_of(mesh, whole);
    double farthest = std::abs(glm::dot(p - corners[0], mesh.normal(whole)));
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 along = corners[(i + 1) % corners.size()] - corners[i];
        const glm::dvec3 out = glm::cross(along, mesh.normal(whole)) / glm::length(along);
        farthest = std::max(farthest, glm::dot(p - corners[i], out));
    }
    return farthest;
}

/// Every shooter is the union of its elements, and these follow one another.
void expect_nested(const Mesh& mesh) {
    std::uint32_t next = 0;
    for (const Shooter& shooter : mesh.shooters) {
        ASSERT_EQ(shooter.first_patch, next);
        ASSERT_GT(shooter.patch_count, 0u);
        next += shooter.patch_count;
        const Patch whole{shooter.corners, shooter.surface};
        double area = 0;
        for (std::uint32_t p = shooter.first_patch; p < next; ++p) {
            const Patch& element = mesh.patches[p];
            ASSERT_EQ(element.surface, shooter.surface);
            EXPECT_NEAR(glm::dot(mesh.normal(element), mesh.normal(whole)), 1, 1e-9);
            area += mesh.area(element);
            for (const auto& corner : corners_of(mesh, element))
                EXPECT_LT(outside(mesh, shooter, corner), 2 * mesh.weld);
        }
        const double length =
            glm::distance(mesh.vertices[shooter.corners[0]], mesh.vertices[shooter.corners[2]]);
        EXPECT_NEAR(area, mesh.area(whole), 8 * mesh.weld * length);
    }
    EXPECT_EQ(next, mesh.patches.size());
}

void expect_in_cells(const Mesh& mesh) {
    for (const Surface& s : mesh.surfaces) {
        ASSERT_EQ(s.cell_of_patch.size(), s.patch_count);
        for (std::uint32_t i = 0; i < s.patch_count; ++i) {
            const glm::dvec2 low(s.cell_of_patch[i] % s.columns, s.cell_of_patch[i] / s.columns);
            const double side = 1u << s.scale(i);
            for (const auto& corner : corners_of(mesh, mesh.patches[s.first_patch + i])) {
                const auto from = corner - s.origin;
                const auto at =
                    glm::dvec2(glm::dot(from, s.u_axis), glm::dot(from, s.v_axis)) / s.cell_size -
                    low;
                EXPECT_TRUE(at.x > -1e-3 && at.x < side + 1e-3) << at.x << " of " << side;
                EXPECT_TRUE(at.y > -1e-3 && at.y < side + 1e-3) << at.y << " of " << side;
            }
        }
    }
}

/// Every face's fragments are its area.
void expect_whole_faces(const Scene& scene, const Mesh& mesh) {
    std::map<std::uint32_t, double> areas;
    for (const Fragment& fragment : mesh.fragments) areas[fragment.face] += fragment.area;
    for (const auto& [face, area] : areas) {
        const auto& corners = scene.faces[face].vertices;
        glm::dvec3 doubled(0);
        for (std::size_t i = 0; i < corners.size(); ++i)
            doubled += glm::cross(scene.positions[corners[i]],
                                  scene.positions[corners[(i + 1) % corners.size()]]);
        EXPECT_NEAR(area, glm::length(doubled) / 2, 1e-5 * area);
    }
}

TEST(Elements, DivideEveryPatchEvenly) {
    const Mesh mesh =
        two_levels(scene_of(halves(rectangle(0, 0, 3, 2))), 0.5, 0.2, Backfaces::cull);

    ASSERT_EQ(mesh.surfaces.size(), 1u);
    EXPECT_EQ(mesh.surfaces[0].columns, 18u);
    EXPECT_EQ(mesh.surfaces[0].rows, 12u);
    EXPECT_EQ(mesh.shooters.size(), 24u);
    EXPECT_EQ(mesh.patches.size(), 216u);
    EXPECT_EQ(mesh.vertices.size(), 19u * 13u);
    for (const Shooter& shooter : mesh.shooters) EXPECT_EQ(shooter.patch_count, 9u);
    expect_nested(mesh);
    expect_in_cells(mesh);
}

TEST(Elements, NestInPatchesOfAnyShape) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        const Scene scene = turned_pieces(seed);
        const Mesh mesh = two_levels(scene, 0.7, 0.13, Backfaces::block);

        EXPECT_GT(mesh.patches.size(), 5 * mesh.shooters.size());
        expect_nested(mesh);
        expect_in_cells(mesh);
        expect_whole_faces(scene, mesh);
    }
}

TEST(Elements, NestInPatchesOfEveryScene) {
    for (const char* name :
         {"cornell.gltf", "furnace.obj", "lroom.obj", "hall2k.obj", "squares.obj"})
        for (const double parts : {1.7, 4.0}) {
            const Scene scene = scene_named(name);
            const double patch_size = default_patch_size(scene) * 2.3;
            const Mesh mesh = two_levels(scene, patch_size, patch_size / parts);

            SCOPED_TRACE(name);
            expect_nested(mesh);
            expect_in_cells(mesh);
            expect_whole_faces(scene, mesh);
        }
}

TEST(Elements, OfPatchesAreThePatchesThatOneLevelHas) {
    const Scene scene = turned_pieces(3);
    const Mesh one = mesh_of(scene, 0.5, Backfaces::block);
    const Mesh two = two_levels(scene, 0.5, 0.1, Backfaces::block);

    ASSERT_EQ(two.shooters.size(), one.patches.size());
    for (std::size_t i = 0; i < one.patches.size(); ++i)
        for (int k = 0; k < 4; ++k)
            EXPECT_EQ(two.vertices[two.shooters[i].corners[k]],
                      one.vertices[one.patches[i].corners[k]]);
}

TEST(Elements, AsLargeAsPatchesLeaveOneLevel) {
    const Scene scene = turned_pieces(3);
    const Mesh one = mesh_of(scene, 0.5);
    const Mesh two = two_levels(scene, 0.5, 0.5, Backfaces::cull);

    EXPECT_TRUE(two.shooters.empty());
    EXPECT_EQ(two.shooter_count(), two.patches.size());
    ASSERT_EQ(two.patches.size(), one.patches.size());
    for (std::size_t i = 0; i < one.patches.size(); ++i)
        EXPECT_EQ(two.patches[i].corners, one.patches[i].corners);
}

TEST(Elements, DividePolygonsThatAreNotCut) {
    const Mesh mesh = two_levels(scene_of(room({0, 0, 0}, {2, 3, 1})), kUncut, 0.5);

    EXPECT_EQ(mesh.shooters.size(), 6u);
    EXPECT_EQ(mesh.patches.size(), 2u * (4 * 6 + 4 * 2 + 6 * 2));
    expect_nested(mesh);
    expect_in_cells(mesh);
}

TEST(Elements, OfBacksAreTheFrontsTurnedOver) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    scene.materials[0].double_sided = true;

    const Mesh mesh = two_levels(scene, 0.5, 0.25);

    ASSERT_EQ(mesh.surfaces.size(), 2u);
    EXPECT_EQ(mesh.shooters.size(), 8u);
    EXPECT_EQ(mesh.parts[0].back_patches, 4u);
    expect_nested(mesh);
    expect_in_cells(mesh);
    for (const Shooter& shooter : mesh.shooters)
        EXPECT_EQ(mesh.normal({shooter.corners, 0}).z, shooter.surface == 0 ? 1 : -1);
}

TEST(Elements, AreNotForBlackBacks) {
    const Mesh mesh = two_levels(scene_of({rectangle(0, 0, 1, 1)}), 0.5, 0.25);

    ASSERT_EQ(mesh.surfaces.size(), 2u);
    EXPECT_EQ(mesh.surfaces[1].patch_count, 1u);
    EXPECT_EQ(mesh.shooters.size(), 5u);
    EXPECT_EQ(mesh.shooters.back().patch_count, 1u);
}

/// As often as `levels` allow, at random.
Mesh split_at_random(const Scene& scene, const MeshSettings& settings, std::mt19937& random) {
    Mesh mesh = build_mesh(scene, settings);
    for (std::uint32_t level = 0; level < settings.split_levels; ++level) {
        Splits splits{std::vector<bool>(mesh.patches.size()),
                      std::vector<bool>(mesh.shooters.size())};
        for (std::size_t i = 0; i < mesh.patches.size(); ++i)
            splits.elements[i] = random() % 3 == 0;
        for (std::size_t i = 0; i < mesh.shooters.size(); ++i)
            splits.shooters[i] = random() % 3 == 0;
        mesh = split_mesh(scene, settings, mesh, splits);
    }
    return mesh;
}

TEST(SplitElements, BecomeFour) {
    const Scene scene = scene_of({rectangle(0, 0, 3, 2)});
    const MeshSettings settings{.patch_size = 1, .split_levels = 2, .backfaces = Backfaces::cull};
    Mesh mesh = build_mesh(scene, settings);
    ASSERT_EQ(mesh.patches.size(), 6u);
    EXPECT_EQ(mesh.surfaces[0].columns, 12u);
    EXPECT_TRUE(mesh.shooters.empty());

    mesh = split_mesh(scene, settings, mesh, {{false, false, false, false, true, false}});

    ASSERT_EQ(mesh.patches.size(), 9u);
    ASSERT_EQ(mesh.shooters.size(), 6u);
    EXPECT_EQ(mesh.shooters[4].patch_count, 4u);
    for (std::uint32_t i = 4; i < 8; ++i) {
        EXPECT_EQ(mesh.surfaces[0].scale(i), 1u);
        EXPECT_NEAR(mesh.area(mesh.patches[i]), 0.25, 1e-15);
    }
    EXPECT_EQ(mesh.surfaces[0].cell_of_patch[4], 4u * 12 + 4);
    EXPECT_EQ(mesh.surfaces[0].cell_of_patch[7], 6u * 12 + 6);
    EXPECT_EQ(mesh.surfaces[0].scale(8), 2u);
    expect_nested(mesh);
    expect_in_cells(mesh);
}

TEST(SplitElements, AreSplitAsOftenAsAllowed) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    const MeshSettings settings{.patch_size = 1, .split_levels = 2, .backfaces = Backfaces::cull};
    Mesh mesh = build_mesh(scene, settings);
    for (const std::size_t count : {4u, 16u, 16u}) {
        mesh = split_mesh(scene, settings, mesh, {std::vector<bool>(mesh.patches.size(), true)});
        EXPECT_EQ(mesh.patches.size(), count);
    }
}

TEST(SplitElements, NestInPatchesOfAnyShape) {
    std::mt19937 random(7);
    for (unsigned seed = 0; seed < 30; ++seed) {
        const Scene scene = turned_pieces(seed);
        const MeshSettings settings{.patch_size = 0.7,
                                    .element_size = 0.3,
                                    .split_levels = 3,
                                    .backfaces = Backfaces::block};
        const Mesh mesh = split_at_random(scene, settings, random);

        const Mesh whole = build_mesh(scene, settings);
        EXPECT_GT(mesh.patches.size(), 2 * whole.patches.size());
        EXPECT_GT(mesh.shooters.size(), 2 * whole.shooters.size());
        expect_nested(mesh);
        expect_in_cells(mesh);
        expect_whole_faces(scene, mesh);
    }
}

TEST(SplitElements, OfBacksAreTheirOwn) {
    Scene scene = scene_of({rectangle(0, 0, 2, 1)});
    scene.materials[0].double_sided = true;
    const MeshSettings settings{.patch_size = 1, .split_levels = 1};
    const Mesh whole = build_mesh(scene, settings);
    ASSERT_EQ(whole.patches.size(), 4u);

    const Mesh mesh = split_mesh(scene, settings, whole, {{true, false, true, false}});

    ASSERT_EQ(mesh.patches.size(), 10u);
    expect_nested(mesh);
    expect_in_cells(mesh);
    for (const std::size_t shooter : {0u, 2u}) {
        EXPECT_EQ(mesh.shooters[shooter].patch_count, 4u);
        for (int k = 0; k < 4; ++k)
            EXPECT_EQ(mesh.vertices[mesh.shooters[shooter].corners[k]],
                      whole.vertices[whole.patches[shooter].corners[k]]);
    }
}

/// The floor is the first surface, the block's bottom the second.
Scene turned_block_on_a_floor(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(0, 6);
    Faces faces{rectangle(0, 0, 3, 2)};
    const double c = std::cos(any(random)), s = std::sqrt(1 - c * c);
    for (auto face : solid_box({-0.8, -0.6, 0}, {0.7, 0.5, 1})) {
        for (auto& p : face) p = {1.5 + c * p.x - s * p.y, 1 + s * p.x + c * p.y, p.z};
        faces.push_back(face);
    }
    return scene_of(faces);
}

void expect_none_straddles(const Scene& scene, const Mesh& mesh, const Patch& patch) {
    const auto& bottom = scene.faces[1].vertices;
    int inside = 0, outside = 0;
    for (const auto& corner : corners_of(mesh, patch)) {
        double depth = 1e9;
        for (std::size_t i = 0; i < 4; ++i) {
            const auto &a = scene.positions[bottom[i]], &b = scene.positions[bottom[(i + 1) % 4]];
            // Clockwise from above: inwards is to the right.
            const glm::dvec3 in = glm::cross(glm::normalize(b - a), glm::dvec3(0, 0, 1));
            depth = std::min(depth, glm::dot(in, corner - a));
        }
        if (depth > 1e-3) ++inside;
        if (depth < -1e-3) ++outside;
    }
    EXPECT_TRUE(inside == 0 || outside == 0);
}

TEST(Elements, AndShootersEndWhereABlockStands) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Scene scene = turned_block_on_a_floor(seed);
        const Mesh mesh = two_levels(scene, 0.7, 0.13, Backfaces::cull);

        for (const Shooter& shooter : mesh.shooters)
            if (shooter.surface == 0)
                expect_none_straddles(scene, mesh, {shooter.corners, shooter.surface});
        for (const Patch& element : mesh.patches)
            if (element.surface == 0) expect_none_straddles(scene, mesh, element);
        expect_nested(mesh);
        expect_in_cells(mesh);
        expect_whole_faces(scene, mesh);
    }
}

TEST(SplitElements, EndWhereABlockStandsAndKeepTheirSides) {
    std::mt19937 random(9);
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Scene scene = turned_block_on_a_floor(seed);
        const MeshSettings settings{.patch_size = 0.7,
                                    .element_size = 0.3,
                                    .split_levels = 2,
                                    .backfaces = Backfaces::cull};
        const Mesh whole = build_mesh(scene, settings);
        const Mesh mesh = split_at_random(scene, settings, random);

        EXPECT_GT(mesh.patches.size(), whole.patches.size());
        ASSERT_EQ(mesh.surfaces[0].side_of_patch.size(), mesh.surfaces[0].patch_count);
        EXPECT_EQ(mesh.surfaces[0].side_count(), 2u);
        for (const Patch& element : mesh.patches)
            if (element.surface == 0) expect_none_straddles(scene, mesh, element);
        expect_nested(mesh);
        expect_in_cells(mesh);
        expect_whole_faces(scene, mesh);
    }
}

Splits all_shooters(const Mesh& mesh) {
    return {std::vector<bool>(mesh.patches.size(), false),
            std::vector<bool>(mesh.shooters.size(), true)};
}

TEST(SplitShooters, BecomeFourOfTheSameElements) {
    const Scene scene = scene_of({rectangle(0, 0, 3, 1)});
    const MeshSettings settings{
        .patch_size = 1, .element_size = 0.25, .split_levels = 2, .backfaces = Backfaces::cull};
    const Mesh whole = build_mesh(scene, settings);
    ASSERT_EQ(whole.shooters.size(), 3u);
    Splits splits = all_shooters(whole);
    splits.shooters = {false, true, false};

    const Mesh mesh = split_mesh(scene, settings, whole, splits);

    ASSERT_EQ(mesh.shooters.size(), 6u);
    EXPECT_EQ(mesh.patches.size(), whole.patches.size());
    for (std::size_t i = 0; i < 6; ++i) {
        const bool part = i > 0 && i < 5;
        EXPECT_EQ(mesh.shooters[i].splits, part ? 1u : 0u);
        EXPECT_EQ(mesh.shooters[i].patch_count, part ? 4u : 16u);
        EXPECT_NEAR(mesh.area({mesh.shooters[i].corners, 0}), part ? 0.25 : 1, 1e-15);
    }
    expect_nested(mesh);
    expect_in_cells(mesh);
}

TEST(SplitShooters, AreSplitAsOftenAsAllowedAndNotBelowElements) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    const auto counts = [&](double element_size, std::uint32_t levels) {
        const MeshSettings settings{.patch_size = 1,
                                    .element_size = element_size,
                                    .split_levels = levels,
                                    .backfaces = Backfaces::cull};
        Mesh mesh = build_mesh(scene, settings);
        std::vector<std::size_t> shooters;
        for (int round = 0; round < 3; ++round) {
            mesh = split_mesh(scene, settings, mesh, all_shooters(mesh));
            shooters.push_back(mesh.shooters.size());
        }
        return shooters;
    };

    EXPECT_EQ(counts(0.125, 2), (std::vector<std::size_t>{4, 16, 16}));
    EXPECT_EQ(counts(0.5, 3), (std::vector<std::size_t>{4, 4, 4}));
}

TEST(SplitShooters, GoOnWhereElementsWereSplit) {
    const Scene scene = scene_of({rectangle(0, 0, 2, 1)});
    const MeshSettings settings{.patch_size = 1, .split_levels = 2, .backfaces = Backfaces::cull};
    Mesh mesh = split_mesh(scene, settings, build_mesh(scene, settings), {{true, false}});
    ASSERT_EQ(mesh.shooters.size(), 2u);

    mesh = split_mesh(scene, settings, mesh, all_shooters(mesh));

    ASSERT_EQ(mesh.shooters.size(), 5u);
    for (const Shooter& shooter : mesh.shooters) EXPECT_EQ(shooter.patch_count, 1u);
    EXPECT_EQ(mesh.shooters[3].splits, 1u);
    EXPECT_EQ(mesh.shooters[4].splits, 0u);
    expect_nested(mesh);
}

TEST(SplitShooters, OfAnOddNumberOfElementsBecomeAsManyParts) {
    const Scene scene = scene_of({rectangle(0, 0, 3, 2)});
    const MeshSettings settings{
        .patch_size = 3, .element_size = 1, .split_levels = 2, .backfaces = Backfaces::cull};
    const Mesh whole = build_mesh(scene, settings);
    ASSERT_EQ(whole.shooters.size(), 1u);

    const Mesh mesh = split_mesh(scene, settings, whole, all_shooters(whole));

    EXPECT_EQ(mesh.shooters.size(), 6u);
    expect_nested(mesh);
}

TEST(SplitShooters, OfBacksAreTheirOwn) {
    Scene scene = scene_of({rectangle(0, 0, 2, 1)});
    scene.materials[0].double_sided = true;
    const MeshSettings settings{.patch_size = 1, .element_size = 0.5, .split_levels = 1};
    const Mesh whole = build_mesh(scene, settings);
    ASSERT_EQ(whole.shooters.size(), 4u);
    Splits splits = all_shooters(whole);
    splits.shooters = {false, false, true, false};

    const Mesh mesh = split_mesh(scene, settings, whole, splits);

    ASSERT_EQ(mesh.shooters.size(), 7u);
    const Shooter& kept = whole.shooters[3];
    for (int k = 0; k < 4; ++k)
        EXPECT_EQ(mesh.vertices[mesh.shooters[6].corners[k]], whole.vertices[kept.corners[k]]);
    for (std::size_t i = 2; i < 6; ++i) EXPECT_EQ(mesh.shooters[i].surface, 1u);
    expect_nested(mesh);
    expect_in_cells(mesh);
}

TEST(Elements, TooSmallAreRefused) {
    const Scene scene = scene_of({rectangle(0, 0, 1, 1)});

    EXPECT_THROW(two_levels(scene, 0.5, 1e-9), InputError);
    EXPECT_THROW(two_levels(scene, 0.5, 2e-5), InputError);
}

}  // namespace
}  // namespace hemirad::mesh_elements_test
