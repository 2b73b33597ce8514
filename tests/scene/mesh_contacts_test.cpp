#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "scene/scenes_by_hand.h"
#include "support/seconds_since.h"

namespace hemirad::mesh_contacts_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;
using Outline = std::vector<glm::dvec3>;

Faces joined(Faces faces, const Faces& more) {
    faces.insert(faces.end(), more.begin(), more.end());
    return faces;
}

Faces without_bottom(Faces box) {
    box.erase(box.begin());
    return box;
}

/// About the axis x = y = 2.
Faces turned(Faces faces, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    for (auto& face : faces)
        for (auto& p : face) {
            const double x = p.x - 2, y = p.y - 2;
            p.x = 2 + std::cos(angle) * x - std::sin(angle) * y;
            p.y = 2 + std::sin(angle) * x + std::cos(angle) * y;
        }
    return faces;
}

/// With an upright side for each edge of the outline, a lid and, seen from below, a bottom.
Faces prism(const Outline& outline, double height) {
    Faces faces{reversed(outline), outline};
    for (auto& p : faces[1]) p.z += height;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
        const glm::dvec3 up(0, 0, height);
        faces.push_back({a, b, b + up, a + up});
    }
    return faces;
}

Outline regular_polygon(int sides, double radius) {
    Outline outline;
    for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        outline.push_back({2 + radius * std::cos(angle), 2 + radius * std::sin(angle), 0});
    }
    return outline;
}

/// 4 x 4 x 4 m.
Faces hall() { return room({0, 0, 0}, {4, 4, 4}); }

bool is_floor(const Mesh& mesh, const Patch& patch) {
    return mesh.normal(patch).z > 0.9 && std::abs(mesh.centroid(patch).z) < 1e-6;
}

std::vector<Patch> floor_of(const Mesh& mesh) {
    std::vector<Patch> patches;
    for (const Patch& patch : mesh.patches)
        if (is_floor(mesh, patch)) patches.push_back(patch);
    return patches;
}

double cross(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.y - a.y * b.x; }

/// What of a convex polygon lies over another, both counter-clockwise from above.
double area_over(Outline polygon, const Outline& other) {
    for (std::size_t i = 0; i < other.size(); ++i) {
        const auto &a = other[i], &b = other[(i + 1) % other.size()];
        Outline kept;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const auto &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
            const double from = cross(b - a, p - a), to = cross(b - a, q - a);
            if (from >= 0) kept.push_back(p);
            if (from * to < 0) kept.push_back(p + (q - p) * (from / (from - to)));
        }
        polygon = kept;
    }
    double doubled = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        doubled += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return doubled / 2;
}

/// Of the floor's patches the smaller part, within or without the footprint, where it is largest.
double largest_straddling(const Mesh& mesh, const Outline& footprint) {
    double largest = 0;
    for (const Patch& patch : floor_of(mesh)) {
        const double covered = area_over(corners_of(mesh, patch), footprint);
        largest = std::max(largest, std::min(covered, mesh.area(patch) - covered));
    }
    return largest;
}

double floor_area(const Mesh& mesh) {
    double area = 0;
    for (const Patch& patch : floor_of(mesh)) area += mesh.area(patch);
    return area;
}

double width_of(const Mesh& mesh, const Patch& patch) {
    const auto corners = corners_of(mesh, patch);
    double longest = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
        longest = std::max(longest, glm::distance(corners[i], corners[(i + 1) % corners.size()]));
    return mesh.area(patch) / longest;
}

double least_width(const Mesh& mesh) {
    double least = 1e9;
    for (const Patch& patch : mesh.patches) least = std::min(least, width_of(mesh, patch));
    return least;
}

/// Whole, convex, and no corner beside an edge without lying on it, to rounding.
void expect_sound(const Mesh& mesh, double rounding = 2e-11) {
    EXPECT_TRUE(mesh.warnings.empty()) << mesh.warnings.front();
    EXPECT_GT(smallest_sine(mesh), 1e-4);
    EXPECT_NEAR(floor_area(mesh), 16, 16 * rounding);
    const auto floor = floor_of(mesh);
    for (const Patch& patch : floor)
        for (const auto& corner : corners_of(mesh, patch))
            for (const Patch& other : floor) {
                const auto edges = corners_of(mesh, other);
                for (std::size_t i = 0; i < edges.size(); ++i) {
                    const auto &a = edges[i], &b = edges[(i + 1) % edges.size()];
                    const double t = glm::dot(corner - a, b - a) / glm::dot(b - a, b - a);
                    const double beside = glm::distance(corner, a + t * (b - a));
                    if (t < 0 || t > 1 || beside > mesh.weld) continue;
                    EXPECT_LT(beside, rounding) << corner.x << ' ' << corner.y;
                }
            }
}

TEST(Contacts, OfABlockCutTheFloorAlongItsBottom) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1})), 1);

    // Four of 4 x 4 cells hold a corner of the block, each its part and the rest in two.
    EXPECT_EQ(floor_of(mesh).size(), 12u + 4 * 3);
    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 2.6, 2.7)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, OfABlockWithoutABottomCutTheFloorAlongItsSides) {
    const auto block = without_bottom(solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1}));
    const Mesh mesh = mesh_of(joined(hall(), block), 1);

    EXPECT_EQ(floor_of(mesh).size(), 12u + 4 * 3);
    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 2.6, 2.7)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, OfASheetWithItsFrontOnTheFloorCutItAlongItsOutline) {
    const auto sheet = reversed(rectangle(1.3, 1.4, 2.6, 2.7));
    const Mesh mesh = mesh_of(joined(hall(), Faces{sheet}), 1);

    EXPECT_EQ(floor_of(mesh).size(), 12u + 4 * 3);
    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 2.6, 2.7)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, OfTurnedBlocksCutTheFloorAtAnyAngle) {
    for (const double degrees : {1.0, 17.0, 45.0, 60.0, 89.999}) {
        const auto block = turned(solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1}), degrees);
        const Mesh mesh = mesh_of(joined(hall(), block), 0.37);

        SCOPED_TRACE(degrees);
        EXPECT_LT(largest_straddling(mesh, reversed(block[0])), 1e-4 * 0.37);
        expect_sound(mesh);
    }
}

TEST(Contacts, OfABlockWithinACellCutFivePatches) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({1.3, 1.4, 0}, {1.5, 1.7, 1})), 1);

    EXPECT_EQ(floor_of(mesh).size(), 15u + 5);
    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 1.5, 1.7)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, AtTheFloorsBorderCutFloorAndWalls) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({0, 0, 0}, {1.5, 1.5, 1.5})), 1);

    // In each of the three planes two cells are cut in two and one, which has a corner, in three.
    EXPECT_EQ(floor_of(mesh).size(), 13u + 2 * 2 + 3);
    EXPECT_EQ(mesh.patches.size(), 3u * 16 + 3 * 20 + 6 * 4);
    EXPECT_LT(largest_straddling(mesh, rectangle(0, 0, 1.5, 1.5)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, AlongTheFloorsBorderAloneCutNothing) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({0, 0, 0}, {4, 4, 1})), 1);

    EXPECT_EQ(floor_of(mesh).size(), 16u);
}

TEST(Contacts, AlongGridLinesCutNothing) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({1, 1, 0}, {3, 2, 1})), 1);

    EXPECT_EQ(floor_of(mesh).size(), 16u);
    EXPECT_EQ(mesh.patches.size(), 6u * 16 + 2 * (2 + 2 + 1));
}

TEST(Contacts, OfTwoBlocksSideBySideCutAlongBoth) {
    const auto blocks =
        joined(solid_box({1.3, 1.4, 0}, {2.1, 2.7, 1}), solid_box({2.1, 1.4, 0}, {2.6, 2.7, 1}));
    const Mesh mesh = mesh_of(joined(hall(), blocks), 1);

    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 2.1, 2.7)), 1e-12);
    EXPECT_LT(largest_straddling(mesh, rectangle(2.1, 1.4, 2.6, 2.7)), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, OfATableAndWhatHangsOverItCutEachOther) {
    auto faces = joined(hall(), solid_box({1, 1, 0}, {2, 2, 1}));
    faces = joined(faces, solid_box({1.5, 1.2, 1}, {2.5, 1.8, 2}));
    const Mesh mesh = mesh_of(faces, 2);

    double under = 0, beside = 0;  // of the upper one's bottom
    for (const Patch& patch : mesh.patches) {
        const auto centre = mesh.centroid(patch);
        if (mesh.normal(patch).z > -0.9 || std::abs(centre.z - 1) > 1e-6) continue;
        (centre.x < 2 ? under : beside) += mesh.area(patch);
        for (const auto& corner : corners_of(mesh, patch))
            EXPECT_TRUE(centre.x < 2 ? corner.x <= 2 : corner.x >= 2);
    }
    EXPECT_NEAR(under, 0.3, 1e-12);
    EXPECT_NEAR(beside, 0.3, 1e-12);
}

TEST(Contacts, OfAPartitionThatEndsWithinTheFloorCutItAlongTheWall) {
    const Mesh mesh =
        mesh_of(joined(hall(), Faces{{{1.5, 0, 0}, {1.5, 2.5, 0}, {1.5, 2.5, 4}, {1.5, 0, 4}}}), 1);

    for (const Patch& patch : floor_of(mesh)) {
        const auto corners = corners_of(mesh, patch);
        if (mesh.centroid(patch).y > 3) continue;
        const auto [low, high] = std::ranges::minmax(corners, {}, &glm::dvec3::x);
        EXPECT_TRUE(high.x <= 1.5 || low.x >= 1.5);
    }
    expect_sound(mesh);
}

/// Of a box, the four upright ones.
Faces sides_of(const Faces& box) { return {box.begin() + 2, box.end()}; }

Outline wall(double x0, double y0, double x1, double y1) {
    return {{x0, y0, 0}, {x1, y1, 0}, {x1, y1, 1}, {x0, y0, 1}};
}

/// Whether a patch of the floor reaches to both sides of the plane x = 2, close to which y is.
bool is_crossed(const Mesh& mesh, double y) {
    return std::ranges::any_of(floor_of(mesh), [&](const Patch& patch) {
        const auto corners = corners_of(mesh, patch);
        return area_over(corners, rectangle(1.9, y, 2, y + 0.1)) > 1e-9 &&
               area_over(corners, rectangle(2, y, 2.1, y + 0.1)) > 1e-9;
    });
}

// The floor falls into pieces along the first wall's line, then, left and right of it, along those
// of others. Two of these on either side are joined again; the two that come out share an edge that
// runs along the first wall, and one beyond its end that runs along none.
TEST(Contacts, OfWallsInOneCellJoinNothingAcrossAnyOfThem) {
    const Mesh mesh = mesh_of(
        joined(hall(), Faces{wall(2, 0, 2, 1.9), wall(0.2, 2, 1.1, 2), wall(1.2, 1.6, 1.2, 2.4),
                             wall(1.5, 3, 1.9, 3), wall(3.8, 2, 2.9, 2), wall(2.8, 1.6, 2.8, 2.4),
                             wall(2.1, 3, 2.5, 3)}),
        4);

    EXPECT_FALSE(is_crossed(mesh, 1));
    EXPECT_EQ(floor_of(mesh).size(), 7u);
    expect_sound(mesh);
}

TEST(Contacts, BehindAFloorDoNotCutItsFront) {
    const auto below = sides_of(solid_box({1.3, 1.4, -1}, {2.6, 2.7, 0}));
    const Mesh mesh = mesh_of(joined(hall(), below), 1);

    EXPECT_EQ(floor_of(mesh).size(), 16u);
}

TEST(Contacts, BehindADoubleSidedFloorCutBothSides) {
    Scene scene = scene_of({rectangle(0, 0, 4, 4)});
    scene.materials.push_back(grey());
    scene.materials[0].double_sided = true;
    for (const auto& wall : sides_of(solid_box({1.3, 1.4, -1}, {2.6, 2.7, 0})))
        add_face(scene, wall, 1);

    const Mesh mesh = mesh_of(scene, 1);

    ASSERT_TRUE(mesh.surfaces[1].is_back || mesh.surfaces.back().is_back);
    EXPECT_EQ(floor_of(mesh).size(), 24u);
    EXPECT_EQ(back_count(mesh), 24u);
}

TEST(Contacts, OnATiledFloorGoOnOverItsTriangles) {
    auto faces = hall();
    faces.erase(faces.begin());
    for (const auto& half : halves(rectangle(0, 0, 4, 4))) faces.push_back(half);
    const Mesh mesh = mesh_of(joined(faces, solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1})), 1);

    EXPECT_EQ(floor_of(mesh).size(), 24u);
    EXPECT_LT(largest_straddling(mesh, rectangle(1.3, 1.4, 2.6, 2.7)), 1e-12);
    std::map<std::uint32_t, double> of_patch;
    for (const Fragment& fragment : mesh.fragments) of_patch[fragment.patch] += fragment.area;
    for (const auto& [patch, area] : of_patch)
        EXPECT_NEAR(area, mesh.area(mesh.patches[patch]), 1e-12);
    expect_sound(mesh);
}

TEST(Contacts, BesideAGridLineLeaveNoSlivers) {
    for (const double beside : {1e-8, 1e-7, 1e-6, 1e-5, 2e-4}) {
        const Mesh mesh = mesh_of(
            joined(hall(), solid_box({1 - beside, 1 + beside, 0}, {3 + beside, 2 - beside, 1})), 1);

        SCOPED_TRACE(beside);
        EXPECT_EQ(floor_of(mesh).size(), 16u);
        EXPECT_GT(least_width(mesh), 0.4);
        expect_sound(mesh);
    }
}

// The corner is drawn to no grid line, nor the floor's vertex on the line to the corner.
TEST(Contacts, OfACornerWithinTheWeldOfAGridLineLeaveVerticesOnIt) {
    const double x = 1 - 3e-7;
    const Outline diamond{{x, 1.5, 0}, {x + 0.4, 1.1, 0}, {x + 0.8, 1.5, 0}, {x + 0.4, 1.9, 0}};
    const Mesh mesh = mesh_of(joined(hall(), prism(diamond, 1)), 1);

    EXPECT_LT(3e-7, mesh.weld);
    EXPECT_LT(largest_straddling(mesh, diamond), 1e-6);
    expect_sound(mesh);
}

TEST(Contacts, OfSlightlyTurnedBlocksLeaveNoSlivers) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(0, 1);
    for (int run = 0; run < 200; ++run) {
        const double degrees = std::pow(10, -7 * any(random));
        const double beside = std::pow(10, -7 * any(random));
        const auto block =
            turned(solid_box({1 - beside, 1, 0}, {3 - beside, 2 + beside, 1}), degrees);
        const Mesh mesh = mesh_of(joined(hall(), block), 1);

        SCOPED_TRACE(degrees);
        EXPECT_LT(largest_straddling(mesh, reversed(block[0])), 1.0 / 2048);
        for (const Patch& patch : floor_of(mesh)) EXPECT_GT(width_of(mesh, patch), 1.0 / 16384);
        // At the tip of a wedge a corner may lie within the weld of its other side.
        expect_sound(mesh, mesh.weld);
    }
}

TEST(Contacts, OfRoundColumnsCutAlongAllTheirSides) {
    const auto outline = regular_polygon(96, 0.4);
    const Mesh mesh = mesh_of(joined(hall(), prism(outline, 4)), 1.7);

    EXPECT_LT(largest_straddling(mesh, outline), 1e-3);
    EXPECT_LT(floor_of(mesh).size(), 300u);
    expect_sound(mesh);
}

TEST(Contacts, OfTooManySidesLeaveTheFloorWhole) {
    const Mesh mesh = mesh_of(joined(hall(), prism(regular_polygon(1000, 0.4), 4)), 4);

    EXPECT_EQ(floor_of(mesh).size(), 1u);
}

TEST(Contacts, DoNotCutPolygonsThatAreNotCut) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1})), kUncut);

    EXPECT_EQ(mesh.patches.size(), 12u);
}

glm::dvec3 tilted(const glm::dvec3& p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
}

TEST(Contacts, OfRandomBlocksOfFloatsLeaveNoPatchHalfCovered) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(0, 1);
    for (int run = 0; run < 100; ++run) {
        auto faces = hall();
        Faces footprints;
        for (int i = 0; i < 3; ++i) {
            const double x = 0.8 + any(random), y = 0.9 + any(random);
            auto block = solid_box({x, y, 0}, {x + any(random), y + any(random), 1});
            block = turned(block, 360 * any(random));
            footprints.push_back(reversed(block[0]));
            faces = joined(faces, any(random) < 0.5 ? block : without_bottom(block));
        }
        Scene scene = scene_of(faces);
        const double tilt = 6 * any(random);
        for (auto& p : scene.positions) p = glm::vec3(tilted(p, tilt));

        Mesh mesh = mesh_of(scene, 0.3 + any(random));
        for (auto& p : mesh.vertices) p = tilted(p, -tilt);

        EXPECT_NEAR(floor_area(mesh), 16, 1e-5);
        EXPECT_GT(smallest_sine(mesh), 1e-5);
        for (const auto& footprint : footprints)
            EXPECT_LT(largest_straddling(mesh, footprint), 1e-3) << run;
    }
}

TEST(Contacts, GiveTheSameMeshAgain) {
    const auto faces = joined(hall(), turned(solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1}), 20));
    const Mesh a = mesh_of(faces, 0.3), b = mesh_of(faces, 0.3);

    EXPECT_EQ(a.vertices, b.vertices);
    ASSERT_EQ(a.patches.size(), b.patches.size());
    for (std::size_t i = 0; i < a.patches.size(); ++i)
        EXPECT_EQ(a.patches[i].corners, b.patches[i].corners);
}

const Surface& floor_surface(const Mesh& mesh) {
    return *std::ranges::find_if(mesh.surfaces, [](const Surface& surface) {
        return surface.normal.z > 0.9 && std::abs(surface.origin.z) < 1e-6;
    });
}

TEST(ContactSides, DifferUnderABlockFromBesideIt) {
    for (const double size : {0.2, 0.35, 1.0}) {
        const Mesh mesh = mesh_of(joined(hall(), solid_box({1.3, 1.4, 0}, {2.6, 2.7, 1})), size);
        const Surface& floor = floor_surface(mesh);

        ASSERT_EQ(floor.side_of_patch.size(), floor.patch_count);
        std::set<std::uint32_t> under, beside;
        for (std::uint32_t i = 0; i < floor.patch_count; ++i) {
            const auto centre = mesh.centroid(mesh.patches[floor.first_patch + i]);
            const bool covered =
                centre.x > 1.3 && centre.x < 2.6 && centre.y > 1.4 && centre.y < 2.7;
            (covered ? under : beside).insert(floor.side(i));
        }
        EXPECT_EQ(under.size(), 1u);
        EXPECT_EQ(beside.size(), 1u);
        EXPECT_NE(under, beside);
    }
}

TEST(ContactSides, DifferWhereABlockStandsOnGridLines) {
    const Mesh mesh = mesh_of(joined(hall(), solid_box({1, 1, 0}, {3, 2, 1})), 0.5);

    const Surface& floor = floor_surface(mesh);
    for (std::uint32_t i = 0; i < floor.patch_count; ++i) {
        const auto centre = mesh.centroid(mesh.patches[floor.first_patch + i]);
        const bool covered = centre.x > 1 && centre.x < 3 && centre.y > 1 && centre.y < 2;
        EXPECT_EQ(floor.side(i) == floor.side(0), !covered);
    }
}

TEST(ContactSides, AreOneRoundAPartitionThatEndsWithinTheFloor) {
    const Outline wall{{1.5, 0, 0}, {1.5, 2.5, 0}, {1.5, 2.5, 4}, {1.5, 0, 4}};

    EXPECT_TRUE(floor_surface(mesh_of(joined(hall(), {wall}), 1)).side_of_patch.empty());
}

TEST(ContactSides, AreTwoOfAPartitionFromWallToWall) {
    const Outline wall{{1.5, 0, 0}, {1.5, 4, 0}, {1.5, 4, 4}, {1.5, 0, 4}};
    const Mesh mesh = mesh_of(joined(hall(), {wall}), 1);

    const Surface& floor = floor_surface(mesh);
    ASSERT_EQ(floor.patch_count, 20u);
    const auto is_left = [&](std::uint32_t i) {
        return mesh.centroid(mesh.patches[floor.first_patch + i]).x < 1.5;
    };
    for (std::uint32_t i = 0; i < floor.patch_count; ++i)
        EXPECT_EQ(floor.side(i) == floor.side(0), is_left(i) == is_left(0));
}

TEST(ContactSides, AreFewUnderManyBlocks) {
    auto faces = hall();
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            faces = joined(faces, solid_box({0.1 + 0.5 * x, 0.1 + 0.5 * y, 0},
                                            {0.4 + 0.5 * x, 0.4 + 0.5 * y, 1}));
    const Mesh mesh = mesh_of(faces, 0.1);

    EXPECT_EQ(floor_surface(mesh).side_count(), 2u);
}

/// side x side blocks on a floor.
Scene blocks_on_a_floor(int side) {
    Scene scene = scene_of({rectangle(0, 0, side, side)});
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (const auto& face : solid_box({x + 0.2, y + 0.3, 0}, {x + 0.7, y + 0.6, 1}))
                add_face(scene, face);
    return scene;
}

double seconds_to_mesh(const Scene& scene) {
    const auto start = std::clock();
    EXPECT_GT(mesh_of(scene, 1).patches.size(), scene.faces.size());
    return test::seconds_since(start);
}

// How they grow does not depend on what else runs.
TEST(ContactSpeed, OfFortyThousandBlocksIsLittleLessThanThatOfTenThousand) {
    const double quarter = seconds_to_mesh(blocks_on_a_floor(100));

    EXPECT_LT(seconds_to_mesh(blocks_on_a_floor(200)), 10 * quarter);
}

TEST(ContactSpeed, OfFacesThatAllCoverEachOtherIsBounded) {
    Scene scene = empty_scene();
    for (int i = 0; i < 2000; ++i)
        add_face(scene, rectangle(1e-3 * i, 0, 50 + 1e-3 * i, 50 + 2e-3 * i));
    const auto start = std::clock();

    const Mesh mesh = mesh_of(scene, 20);

    EXPECT_LT(test::seconds_since(start), 20);
    EXPECT_TRUE(std::ranges::any_of(mesh.warnings, [](const std::string& warning) {
        return warning == "hand.obj: too many faces touch to cut all along one another";
    }));
}

}  // namespace
}  // namespace hemirad::mesh_contacts_test
