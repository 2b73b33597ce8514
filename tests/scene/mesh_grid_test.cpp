#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <map>
#include <numbers>
#include <random>

#include "errors.h"
#include "scene/scenes_by_hand.h"
#include "support/seconds_since.h"

namespace hemirad::mesh_grid_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

Faces turned(Faces faces, double angle, glm::dvec3 shift) {
    const double c = std::cos(angle), s = std::sin(angle);
    for (auto& face : faces)
        for (auto& p : face) {
            p = glm::dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
            p = glm::dvec3(p.x, c * p.y - s * p.z, s * p.y + c * p.z) + shift;
        }
    return faces;
}

Faces fan(const std::vector<glm::dvec3>& outline, glm::dvec3 hub) {
    Faces faces;
    for (std::size_t i = 0; i < outline.size(); ++i)
        faces.push_back({outline[i], outline[(i + 1) % outline.size()], hub});
    return faces;
}

std::size_t quad_count(const Mesh& mesh) {
    return static_cast<std::size_t>(
        std::ranges::count_if(mesh.patches, [](const Patch& p) { return !p.is_triangle(); }));
}

TEST(Grid, RectangleOfTwoTrianglesBecomesColumnsTimesRowsQuads) {
    const Mesh mesh = mesh_of(halves(rectangle(0, 0, 3, 2)), 0.5);

    ASSERT_EQ(mesh.surfaces.size(), 1u);
    EXPECT_EQ(mesh.surfaces[0].columns, 6u);
    EXPECT_EQ(mesh.surfaces[0].rows, 4u);
    EXPECT_EQ(mesh.patches.size(), 24u);
    EXPECT_EQ(quad_count(mesh), 24u);
    EXPECT_EQ(mesh.vertices.size(), 7u * 5u);
    for (const Patch& patch : mesh.patches) EXPECT_NEAR(mesh.area(patch), 0.25, 1e-15);
}

TEST(Grid, FansAndTurnedRectanglesBecomeColumnsTimesRowsQuads) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> anywhere(0.05, 0.95);
    for (int run = 0; run < 200; ++run) {
        const double width = 1 + anywhere(random), height = anywhere(random);
        const auto outline = rectangle(0, 0, width, height);
        const glm::dvec3 hub(width * anywhere(random), height * anywhere(random), 0);
        const auto faces = turned(fan(outline, hub), 6 * anywhere(random), {1, -2, 3});

        const Mesh mesh = mesh_of(faces, 0.17);

        const auto columns = static_cast<std::size_t>(std::ceil(width / 0.17));
        const auto rows = static_cast<std::size_t>(std::ceil(height / 0.17));
        ASSERT_EQ(mesh.surfaces.size(), 1u);
        EXPECT_EQ(mesh.patches.size(), columns * rows);
        EXPECT_EQ(quad_count(mesh), columns * rows);
        EXPECT_EQ(mesh.vertices.size(), (columns + 1) * (rows + 1));
        EXPECT_NEAR(total_area(mesh) / (width * height), 1, 1e-12);
        EXPECT_NEAR(mesh.patches.size() * mesh.area(mesh.patches[0]), width * height, 1e-12);
    }
}

TEST(Grid, RectanglesRoundedToFloatsStillBecomeQuads) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> anywhere(0.05, 0.95);
    for (int run = 0; run < 100; ++run) {
        const glm::dvec3 hub(2 * anywhere(random), anywhere(random), 0);
        auto faces = turned(fan(rectangle(0, 0, 2, 1), hub), 6 * anywhere(random), {5, 0, 1});
        double area = 0;
        for (auto& face : faces) {
            for (auto& p : face) p = glm::vec3(p);
            area += glm::length(glm::cross(face[1] - face[0], face[2] - face[0])) / 2;
        }

        const Mesh mesh = mesh_of(faces, 0.25);

        EXPECT_EQ(mesh.patches.size(), 32u);
        EXPECT_EQ(quad_count(mesh), 32u);
        EXPECT_NEAR(total_area(mesh) / area, 1, 1e-12);
    }
}

TEST(Grid, KeepsInputCornersBitForBit) {
    const auto faces = turned(halves(rectangle(0, 0, 3, 2)), 0.7, {0.1, 0.2, 0.3});

    const Mesh mesh = mesh_of(faces, 0.5);

    for (const auto& face : faces)
        for (const auto& corner : face)
            EXPECT_TRUE(std::ranges::any_of(mesh.vertices, [&](const glm::dvec3& v) {
                return std::memcmp(&v, &corner, sizeof v) == 0;
            }));
}

TEST(Grid, FramePlacesEveryPatchInItsCell) {
    const Mesh mesh =
        mesh_of(turned(halves(rectangle(0, 0, 3, 2)), 0.7, {0.1, 0.2, 0.3}), 0.5, Backfaces::block);

    for (const Surface& s : mesh.surfaces) {
        EXPECT_NEAR(glm::distance(glm::cross(s.u_axis, s.v_axis), s.normal), 0, 1e-14);
        for (std::uint32_t i = 0; i < s.patch_count; ++i) {
            const Patch& patch = mesh.patches[s.first_patch + i];
            EXPECT_NEAR(glm::dot(mesh.normal(patch), s.normal), 1, 1e-14);
            const glm::dvec3 centre = mesh.centroid(patch) - s.origin;
            const double column = std::floor(glm::dot(centre, s.u_axis) / s.cell_size.x);
            const double row = std::floor(glm::dot(centre, s.v_axis) / s.cell_size.y);
            EXPECT_EQ(s.cell_of_patch[i], row * s.columns + column);
        }
    }
}

TEST(Grid, MirroredBackHasTheFrontsCells) {
    Scene scene = scene_of(halves(rectangle(0, 0, 3, 2)));
    scene.materials[0].double_sided = true;

    const Mesh mesh = mesh_of(scene, 1);

    ASSERT_EQ(mesh.surfaces.size(), 2u);
    const Surface& back = mesh.surfaces[1];
    for (std::uint32_t i = 0; i < back.patch_count; ++i) {
        const Patch& patch = mesh.patches[back.first_patch + i];
        const glm::dvec3 centre = mesh.centroid(patch) - back.origin;
        EXPECT_NEAR(mesh.normal(patch).z, -1, 1e-15);
        EXPECT_EQ(back.cell_of_patch[i], std::floor(glm::dot(centre, back.v_axis)) * back.columns +
                                             std::floor(glm::dot(centre, back.u_axis)));
    }
}

TEST(Grid, LShapeHasItsAreaAndOnlyQuadsWhereCellsFit) {
    const std::vector<glm::dvec3> outline{{0, 0, 0}, {4, 0, 0}, {4, 1, 0},
                                          {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};

    const Mesh mesh = mesh_of(Faces{outline}, 0.5);

    EXPECT_EQ(mesh.surfaces[0].columns, 8u);
    EXPECT_EQ(mesh.surfaces[0].rows, 6u);
    EXPECT_EQ(mesh.patches.size(), 24u);
    EXPECT_EQ(quad_count(mesh), 24u);
    EXPECT_NEAR(total_area(mesh), 6, 1e-12);
}

TEST(Grid, ReflexCornerInsideACellLeavesConvexPatches) {
    const std::vector<glm::dvec3> outline{{0, 0, 0},     {4, 0, 0},   {4, 1.3, 0},
                                          {1.7, 1.3, 0}, {1.7, 3, 0}, {0, 3, 0}};

    const Mesh mesh = mesh_of(Faces{outline}, 1);

    EXPECT_NEAR(total_area(mesh), 4 * 1.3 + 1.7 * 1.7, 1e-12);
    EXPECT_GT(smallest_sine(mesh), 0.01);
}

TEST(Grid, WallWithAWindowKeepsTheHole) {
    const Faces frame{rectangle(0, 0, 4, 1), rectangle(0, 2, 4, 3)};
    Faces faces = frame;
    // Around a window from (1, 1) to (2.5, 2); the long walls have T-junctions with these.
    faces.push_back(rectangle(0, 1, 1, 2));
    faces.push_back(rectangle(2.5, 1, 4, 2));

    const Mesh mesh = mesh_of(faces, 0.4);

    EXPECT_NEAR(total_area(mesh), 12 - 1.5, 1e-12);
    for (const Patch& patch : mesh.patches) {
        const glm::dvec3 centre = mesh.centroid(patch);
        EXPECT_FALSE(centre.x > 1 && centre.x < 2.5 && centre.y > 1 && centre.y < 2);
    }
}

TEST(Grid, RandomPolygonsKeepTheirAreaAndGiveConvexPatches) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> radius(0.3, 1), any(0, 1);
    for (int run = 0; run < 300; ++run) {
        std::vector<glm::dvec3> star;
        const int n = 3 + run % 9;
        for (int i = 0; i < n; ++i) {
            const double angle = 2 * std::numbers::pi * i / n;
            star.push_back(radius(random) * glm::dvec3(std::cos(angle), std::sin(angle), 0));
        }
        double area = 0;
        for (int i = 0; i < n; ++i) area += glm::cross(star[i], star[(i + 1) % n]).z / 2;
        const auto faces = turned(run % 2 ? Faces{star} : fan(star, {0, 0, 0}), any(random), {});

        const Mesh mesh = mesh_of(faces, 0.11);

        EXPECT_EQ(mesh.surfaces.size(), 1u);
        EXPECT_TRUE(mesh.warnings.empty());
        EXPECT_NEAR(total_area(mesh) / area, 1, 1e-12) << "run " << run;
        EXPECT_GT(smallest_sine(mesh), 1e-5);
    }
}

TEST(Grid, FragmentsOfAFaceAddUpToItsArea) {
    const auto outline = rectangle(0, 0, 3, 2);
    const Scene scene = scene_of(fan(outline, {1.1, 0.7, 0}));

    const Mesh mesh = mesh_of(scene, 0.37, Backfaces::block);

    std::map<std::uint32_t, double> of_face, of_patch;
    for (const auto& [face, patch, area] : mesh.fragments) {
        of_face[face] += area;
        of_patch[patch] += area;
    }
    EXPECT_NEAR(of_face[0], 3 * 0.7 / 2, 1e-13);
    EXPECT_NEAR(of_face[1], 2 * 1.9 / 2, 1e-13);
    EXPECT_NEAR(of_face[2], 3 * 1.3 / 2, 1e-13);
    EXPECT_NEAR(of_face[3], 2 * 1.1 / 2, 1e-13);
    for (const auto& [patch, area] : of_patch)
        EXPECT_NEAR(area, mesh.area(mesh.patches[patch]), 1e-14);
    EXPECT_TRUE(std::ranges::is_sorted(
        mesh.fragments, {}, [](const Fragment& f) { return std::pair(f.face, f.patch); }));
}

TEST(Grid, ConcaveFaceHasOneFragmentAPatch) {
    const std::vector<glm::dvec3> outline{{0, 0, 0}, {4, 0, 0}, {4, 1, 0},
                                          {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};

    const Mesh mesh = mesh_of(Faces{outline}, 0.5);

    ASSERT_EQ(mesh.fragments.size(), 24u);
    for (const Fragment& fragment : mesh.fragments) EXPECT_NEAR(fragment.area, 0.25, 1e-14);
}

TEST(Grid, FragmentsOfACutCellGoToTheRightPatches) {
    const Mesh mesh =
        mesh_of(Faces{{{0, 0, 0}, {3, 0, 0}, {3, 2.5, 0}, {2.5, 3, 0}, {0, 3, 0}}}, 3);

    ASSERT_EQ(mesh.patches.size(), 2u);
    ASSERT_EQ(mesh.fragments.size(), 2u);
    for (const auto& [face, patch, area] : mesh.fragments)
        EXPECT_NEAR(area, mesh.area(mesh.patches[patch]), 1e-14);
    EXPECT_NEAR(total_area(mesh), 9 - 0.125, 1e-14);
}

TEST(Grid, VertexBesideAGridLineCountsAsOnIt) {
    const double beside = 1 + 3e-7;

    const Mesh mesh = mesh_of(Faces{rectangle(0, 0, beside, 1), rectangle(beside, 0, 2, 1)}, 1);

    ASSERT_EQ(mesh.patches.size(), 2u);
    EXPECT_DOUBLE_EQ(mesh.area(mesh.patches[0]), beside);
    EXPECT_DOUBLE_EQ(total_area(mesh), 2);
}

// Where they are narrower than twice the weld, nothing is left: of a triangle's tips, a thousandth.
TEST(Grid, NarrowFaceKeepsItsAreaHoweverManyLinesCutIt) {
    Scene scene = scene_of({{{0, 0, 0}, {0, 0.75, 0x1p-16}, {0, 1, 0}}});
    scene.quantum = 0x1p-24;  // the weld is 2^-22, a 64th of the height
    for (const double size : {0.3, 0.01, 0.002, 0.0005, 0.0001}) {
        const Mesh mesh = build_mesh(scene, {.patch_size = size, .backfaces = Backfaces::cull});
        EXPECT_NEAR(total_area(mesh) / 0x1p-17, 1, 2e-3) << size;
    }
}

TEST(Grid, OfWhichNothingIsLeftIsAnInputError) {
    Scene scene = scene_of({{{0, 0, 0}, {0, 0.75, 2.1 * 0x1p-22}, {0, 1, 0}}});
    scene.quantum = 0x1p-24;
    EXPECT_THAT([&] { build_mesh(scene, {.patch_size = 0.1}); },
                testing::ThrowsMessage<InputError>(
                    "hand.obj: no face is wide enough to be cut into patches of 0.10 m"));
}

// Every directed edge of a patch meets its reverse, or lies on edges of others end to end.
TEST(Grid, ClosedBoxIsWatertight) {
    const Mesh mesh = mesh_of(room({0, 0, 0}, {1, 2, 3}), 0.25);

    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    for (const Patch& patch : mesh.patches)
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t a = patch.corners[i], b = patch.corners[(i + 1) % 4];
            if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    for (const auto& [edge, sum] : balance) EXPECT_EQ(sum, 0);
    EXPECT_EQ(mesh.patches.size(), 2u * (4 * 8 + 4 * 12 + 8 * 12));
    EXPECT_TRUE(mesh.closed);
}

TEST(Grid, ObjectsAndMaterialsDoNotMerge) {
    Scene scene = empty_scene();
    scene.objects = {"a", "b"};
    scene.materials = {grey(), grey()};
    add_face(scene, rectangle(0, 0, 1, 1), 0, 0);
    add_face(scene, rectangle(1, 0, 2, 1), 1, 0);
    add_face(scene, rectangle(0, 1, 1, 2), 0, 1);

    const Mesh mesh = mesh_of(scene, 10);

    EXPECT_EQ(mesh.surfaces.size(), 3u);
    EXPECT_EQ(mesh.patches.size(), 3u);
}

TEST(Grid, SlightlyTurnedNeighbourIsASurfaceOfItsOwn) {
    const Mesh mesh = mesh_of(
        Faces{rectangle(0, 0, 1, 1), {{1, 0, 0}, {2, 0, 1e-4}, {2, 1, 1e-4}, {1, 1, 0}}}, 10);

    EXPECT_EQ(mesh.surfaces.size(), 2u);
}

TEST(Grid, InfinitePatchSizeGivesAPatchAFace) {
    Faces faces = halves(rectangle(0, 0, 3, 2));
    faces.push_back(rectangle(3, 0, 4, 2));

    const Mesh mesh = mesh_of(faces, kUncut);

    ASSERT_EQ(mesh.patches.size(), 3u);
    EXPECT_EQ(mesh.surfaces.size(), 3u);
    for (std::uint32_t i = 0; i < 3; ++i) {
        EXPECT_EQ(mesh.fragments[i].face, i);
        EXPECT_EQ(mesh.fragments[i].patch, i);
    }
}

TEST(Grid, InfinitePatchSizeCutsWhatIsNotAConvexQuad) {
    const Faces arrow{{{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}}};
    const Faces straight_corner{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}};

    EXPECT_EQ(mesh_of(arrow, kUncut).patches.size(), 2u);
    EXPECT_EQ(mesh_of(straight_corner, kUncut).patches.size(), 1u);
}

TEST(Grid, SameSceneSameMesh) {
    const Scene scene = scene_of(fan(rectangle(0, 0, 3, 2), {1.1, 0.7, 0}));

    const Mesh a = mesh_of(scene, 0.1, Backfaces::block);
    const Mesh b = mesh_of(scene, 0.1, Backfaces::block);

    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    EXPECT_EQ(
        std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(glm::dvec3)),
        0);
    ASSERT_EQ(a.patches.size(), b.patches.size());
    for (std::size_t i = 0; i < a.patches.size(); ++i)
        EXPECT_EQ(a.patches[i].corners, b.patches[i].corners);
}

TEST(Grid, SurfacesOwnTheirPatchesFrontsFirst) {
    const Mesh mesh = mesh_of(room({0, 0, 0}, {1, 2, 3}), 0.5, Backfaces::block);

    std::uint32_t next = 0;
    bool backs = false;
    for (std::uint32_t s = 0; s < mesh.surfaces.size(); ++s) {
        const Surface& surface = mesh.surfaces[s];
        EXPECT_EQ(surface.first_patch, next);
        EXPECT_EQ(surface.cell_of_patch.size(), surface.patch_count);
        EXPECT_TRUE(surface.is_back || !backs);
        backs = surface.is_back;
        for (std::uint32_t i = 0; i < surface.patch_count; ++i)
            EXPECT_EQ(mesh.patches[next + i].surface, s);
        next += surface.patch_count;
    }
    EXPECT_EQ(next, mesh.patches.size());
}

TEST(Grid, CornellBoxGetsThousandsOfPatchesByDefault) {
    const Mesh mesh = mesh_of(room({0, 0, 0}, {0.556, 0.549, 0.559}), 0);

    EXPECT_GT(mesh.patches.size(), 2000u);
    EXPECT_LT(mesh.patches.size(), 5000u);
}

TEST(DefaultPatchSize, HasTwoDigits) {
    EXPECT_DOUBLE_EQ(default_patch_size(scene_of({rectangle(0, 0, 3, 1)})), 0.032);
    EXPECT_DOUBLE_EQ(default_patch_size(scene_of({rectangle(0, 0, 3000, 1000)})), 32);
}

// side x side quads in one plane.
Scene sheet_of_quads(std::uint32_t side) {
    Scene scene = empty_scene();
    for (std::uint32_t y = 0; y <= side; ++y)
        for (std::uint32_t x = 0; x <= side; ++x)
            scene.positions.push_back({x * 0.01, y * 0.01, 0.001 * x});
    for (std::uint32_t y = 0; y < side; ++y)
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = y * (side + 1) + x;
            scene.faces.push_back({{a, a + 1, a + side + 2, a + side + 1}, 0, 0});
        }
    return scene;
}

double seconds_to_mesh(const Scene& scene) {
    const auto start = std::clock();
    const Mesh uncut = mesh_of(scene, kUncut);
    EXPECT_EQ(uncut.patches.size(), scene.faces.size());
    return test::seconds_since(start);
}

// Some three seconds where nothing else runs; how they grow does not depend on what else does.
TEST(Speed, OfAMillionQuadsIsLittleLessThanThatOfAQuarterMillion) {
    const double quarter = seconds_to_mesh(sheet_of_quads(500));
    const Scene million = sheet_of_quads(1000);

    EXPECT_LT(seconds_to_mesh(million), 10 * quarter);
    EXPECT_EQ(mesh_of(million, 1).patches.size(), 110u);
}

}  // namespace
}  // namespace hemirad::mesh_grid_test
