#include <cmath>
#include <functional>

#include "lightmap/rasterize.h"
#include "lightmap/support.h"
#include "scene/scenes_by_hand.h"

// Light that stays on its side of what stands on a surface, and goes on where nothing does.
namespace hemirad::clean_texels_test {
namespace {

using Quad = std::vector<glm::dvec3>;

/// Both sides of an upright wall along y at x, without thickness.
void add_wall(Scene& scene, double x, double y0, double y1) {
    const Quad wall{{x, y0, 0}, {x, y1, 0}, {x, y1, 1}, {x, y0, 1}};
    add_face(scene, wall, 0, 1);
    add_face(scene, reversed(wall), 0, 1);
}

Scene floor_of(double x0, double y0, double x1, double y1) {
    Scene scene = empty_scene();
    scene.objects = {"floor", "wall", "tile"};
    add_face(scene, rectangle(x0, y0, x1, y1));
    return scene;
}

using Light = std::function<double(const glm::dvec3&)>;

struct Baked {
    Mesh mesh;
    ChartLayout layout;
    Lightmap lightmap;

    const Surface& surface(std::uint32_t i) const {
        return mesh.surfaces[layout.charts[i].surface];
    }

    /// As a renderer filters: bilinear between the four texels about the point.
    double sample(std::uint32_t chart, const glm::dvec3& point) const {
        const glm::dvec2 at = atlas_from_world(layout.charts[chart], surface(chart), point) - 0.5;
        const glm::dvec2 low(std::floor(at.x), std::floor(at.y)), part = at - low;
        const auto texel = [&](int right, int down) -> double {
            return lightmap.values[0][texel_at(lightmap, std::uint32_t(low.x) + right,
                                               std::uint32_t(low.y) + down)];
        };
        return (texel(0, 0) * (1 - part.x) + texel(1, 0) * part.x) * (1 - part.y) +
               (texel(0, 1) * (1 - part.x) + texel(1, 1) * part.x) * part.y;
    }
};

Baked bake(const Scene& scene, double patch_size, const Light& light, double texel_size = 0) {
    Baked baked{build_mesh(scene, {.patch_size = patch_size}), {}, {}};
    std::vector<double> values;
    for (const Patch& patch : baked.mesh.patches)
        values.push_back(light(baked.mesh.centroid(patch)));
    baked.layout = lay_out_charts(baked.mesh, {.texel_size = texel_size});
    baked.lightmap = rasterize(baked.mesh, solution_of(values), baked.layout, Quantity::irradiance);
    return baked;
}

/// All values of the first chart, gutter included, by what they should be.
void expect_floor(const Baked& baked, const Light& light) {
    const Chart& chart = baked.layout.charts[0];
    const Surface& surface = baked.surface(0);
    for (std::uint32_t y = 0; y < chart.height; ++y)
        for (std::uint32_t x = 0; x < chart.width; ++x) {
            const glm::dvec3 at = surface.origin + (x + 0.5) * chart.texel_size.x * surface.u_axis +
                                  (chart.height - y - 0.5) * chart.texel_size.y * surface.v_axis;
            EXPECT_NEAR(
                baked.lightmap.values[0][texel_at(baked.lightmap, chart.x + x, chart.y + y)],
                light(at), 1e-6)
                << at.x << ' ' << at.y;
        }
}

TEST(CleanTexels, LightDoesNotCrossAWallThatPartsAFloor) {
    Scene scene = floor_of(0, 0, 4, 2);
    add_wall(scene, 1.7, 0, 2);
    const Light light = [](const glm::dvec3& at) { return at.x < 1.7 ? 0.0 : 8.0; };

    expect_floor(bake(scene, 0.5, light, 0.1), light);
}

TEST(CleanTexels, LightDoesNotCrossAWallThatEndsOnTheFloor) {
    Scene scene = floor_of(0, 0, 4, 4);
    add_wall(scene, 2, 0, 2.5);
    const Light light = [](const glm::dvec3& at) { return at.x < 2 ? 0.0 : 8.0; };

    const Baked baked = bake(scene, 0.5, light);

    for (const double y : {0.3, 1.2, 1.9}) {
        EXPECT_NEAR(baked.sample(0, {1.7, y, 0}), 0, 1e-6);
        EXPECT_NEAR(baked.sample(0, {2.3, y, 0}), 8, 1e-6);
    }
    EXPECT_GT(baked.sample(0, {1.9, 3.5, 0}), 2);  // beyond its end it may
}

TEST(CleanTexels, WhatLiesUnderABlockShowsTheLightBesideIt) {
    for (const bool has_bottom : {true, false}) {
        Scene scene = floor_of(0, 0, 4, 4);
        for (const auto& face : solid_box({1.3, 1.2, 0}, {2.9, 2.7, 1}))
            if (has_bottom || face[0].z + face[1].z + face[2].z > 0) add_face(scene, face, 0, 1);
        const auto covered = [](const glm::dvec3& at) {
            return at.z == 0 && at.x > 1.3 && at.x < 2.9 && at.y > 1.2 && at.y < 2.7;
        };

        const Baked baked =
            bake(scene, 0.5, [&](const glm::dvec3& at) { return covered(at) ? 0.0 : 5.0; });

        expect_floor(baked, [](const glm::dvec3&) { return 5.0; });
    }
}

void add_solid(Scene& scene, const glm::dvec3& low, const glm::dvec3& high) {
    for (const auto& face : solid_box(low, high)) add_face(scene, face, 0, 1);
}

Light dark_between(const glm::dvec2& low, const glm::dvec2& high) {
    return [=](const glm::dvec3& at) {
        return at.x > low.x && at.x < high.x && at.y > low.y && at.y < high.y ? 0.0 : 5.0;
    };
}

// Of a table, its leg's top up to its board's bottom, into it or not quite: what comes first above
// the leg's foot is the inside of the leg or the bottom of the board.
TEST(CleanTexels, WhatLiesUnderALegShowsTheLightBesideItWhateverTheLegCarries) {
    for (const bool in_a_room : {true, false})
        for (const double top : {0.7, 0.71, 0.69}) {
            Scene scene = floor_of(0, 0, 4, 4);
            add_solid(scene, {1.3, 1.2, 0}, {1.5, 1.4, top});
            add_solid(scene, {1.1, 1.0, 0.7}, {2.9, 2.7, 0.75});
            if (in_a_room)
                for (const auto& face : room({0, 0, 0}, {4, 4, 2}))
                    if (face[0].z + face[1].z + face[2].z > 0) add_face(scene, face, 0, 2);

            const Baked baked = bake(scene, 0.5, dark_between({1.3, 1.2}, {1.5, 1.4}));

            expect_floor(baked, [](const glm::dvec3&) { return 5.0; });
        }
}

TEST(CleanTexels, WhatLiesUnderAPillarShowsTheLightBesideIt) {
    for (const double x : {1.3, 0.0}) {  // free, and at a wall
        Scene scene = floor_of(0, 0, 4, 4);
        for (const auto& face : room({0, 0, 0}, {4, 4, 2}))
            if (face[0].z + face[1].z + face[2].z > 0) add_face(scene, face, 0, 2);
        add_solid(scene, {x, 1.2, 0}, {x + 0.5, 1.9, 2});

        const Baked baked = bake(scene, 0.5, dark_between({x, 1.2}, {x + 0.5, 1.9}));

        expect_floor(baked, [](const glm::dvec3&) { return 5.0; });
    }
}

TEST(CleanTexels, TheFloorUnderATableIsNotTakenForOneUnderABlock) {
    Scene scene = floor_of(0, 0, 4, 4);
    add_solid(scene, {1.1, 1.0, 0.7}, {2.9, 2.7, 0.75});
    add_wall(scene, 2, 0, 4);
    const Light light = [](const glm::dvec3& at) { return at.x < 2 ? 0.0 : 5.0; };

    expect_floor(bake(scene, 0.5, light, 0.1), light);
}

TEST(CleanTexels, ADarkRoomThatIsShutIsNotTakenForABlock) {
    Scene scene = floor_of(0, 0, 4, 4);
    for (const auto& face : solid_box({1, 1, 0}, {3, 3, 1})) {
        if (face[0].z + face[1].z + face[2].z == 0) continue;  // it stands on the floor
        add_face(scene, face, 0, 1);
        add_face(scene, reversed(face), 0, 1);
    }
    const Light light = [](const glm::dvec3& at) {
        return at.x > 1 && at.x < 3 && at.y > 1 && at.y < 3 ? 0.0 : 5.0;
    };

    expect_floor(bake(scene, 0.4, light, 0.1), light);
}

TEST(CleanTexels, ATexelAtTheCornerOfARoomIsOnTheSideOfItsCentre) {
    Scene scene = floor_of(0, 0, 4, 4);
    add_wall(scene, 1.42, 0, 1.42);
    const Quad other{{0, 1.42, 0}, {1.42, 1.42, 0}, {1.42, 1.42, 1}, {0, 1.42, 1}};
    add_face(scene, other, 0, 1);
    add_face(scene, reversed(other), 0, 1);
    const Light light = [](const glm::dvec3& at) { return at.x < 1.42 && at.y < 1.42 ? 0.0 : 8.0; };

    expect_floor(bake(scene, 0.5, light, 0.25), light);
    expect_floor(bake(scene, 0.5, light, 0.4), light);
    expect_floor(bake(scene, 1.0, light, 0.4), light);
}

Scene two_tiles(double split, double left_width, double right_width) {
    Scene scene = floor_of(split - left_width, 0, split, 2);
    add_face(scene, rectangle(split, 0, split + right_width, 2), 0, 2);
    return scene;
}

void expect_no_seam(const Baked& baked, double x) {
    for (double y = 0.05; y < 2; y += 0.05) {
        const double here = baked.sample(0, {x, y, 0}), there = baked.sample(1, {x, y, 0});
        EXPECT_NEAR(here / there, 1, 0.005) << y;
    }
}

TEST(CleanTexels, ChartsThatMeetInAPlaneAgreeAlongTheirEdge) {
    const Light light = [](const glm::dvec3& at) { return 3 + at.x + 0.3 * at.x * at.x + at.y; };

    expect_no_seam(bake(two_tiles(2, 2, 2), 0.25, light), 2);
    expect_no_seam(bake(two_tiles(2, 1.9, 1.3), 0.25, light), 2);
    expect_no_seam(bake(two_tiles(2, 2, 1.1), 0.4, light, 0.07), 2);
}

TEST(CleanTexels, ChartsThatMeetUnderAWallKeepToThemselves) {
    Scene scene = two_tiles(2, 2, 2);
    add_wall(scene, 2, -1, 3);
    const Light light = [](const glm::dvec3& at) { return at.x < 2 ? 0.0 : 8.0; };

    const Baked baked = bake(scene, 0.5, light);

    expect_floor(baked, light);
    EXPECT_EQ(baked.sample(0, {2, 1, 0}), 0);
    EXPECT_EQ(baked.sample(1, {2, 1, 0}), 8);
}

TEST(CleanTexels, FloorsOnBothSidesOfAThickWallKeepToThemselves) {
    Scene scene = floor_of(0, 0, 2, 2);
    add_face(scene, rectangle(2.1, 0, 4, 2), 0, 2);
    for (const auto& face : solid_box({2, 0, 0}, {2.1, 2, 1})) add_face(scene, face, 0, 1);
    const Light light = [](const glm::dvec3& at) { return at.x < 2.05 ? 0.0 : 8.0; };

    const Baked baked = bake(scene, 0.5, light);

    expect_floor(baked, light);
    EXPECT_EQ(baked.sample(1, {2.1, 1, 0}), 8);
}

}  // namespace
}  // namespace hemirad::clean_texels_test
