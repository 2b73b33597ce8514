#include "view/render.h"

#include <gtest/gtest.h>

#include <numbers>

#include "errors.h"
#include "lit_scenes.h"

namespace hemirad::render_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// From the origin along -z, a right angle from top to bottom.
const Camera kCamera{"camera", {}, {0, 0, -1}, {0, 1, 0}, kPi / 2, 1};

RenderSettings small(std::uint32_t size, std::uint32_t samples = 1) {
    return {.width = size, .height = size, .samples = samples};
}

double at(const Lightmap& picture, std::uint32_t x, std::uint32_t y) {
    return picture.values[0][y * picture.width + x];
}

TEST(Render, ASurfaceShowsWhatItReflectsAndEmits) {
    LitScene lit = scene_lit_by({6});
    add_material(lit, 0.5, 0.25);
    add_wall(lit, -5);

    const Lightmap picture = render(lit, kCamera, small(3));

    EXPECT_NEAR(at(picture, 1, 1), 0.5 * 6 / kPi + 0.25, 1e-6);
    EXPECT_EQ(picture.coverage, std::vector<float>(9, 1.0f));
}

TEST(Render, EachMaterialShowsItsOwnAtlas) {
    LitScene lit = scene_lit_by({6});
    add_atlas(lit, {2, 4});
    add_material(lit, 1, 0, 1);
    add_wall(lit, -5);  // between the second atlas's texels

    EXPECT_NEAR(at(render(lit, kCamera, small(1)), 0, 0), 3 / kPi, 1e-6);
}

TEST(Render, OfRadiosityAPiThIsSeen) {
    LitScene lit = scene_lit_by({6});
    lit.quantity = Quantity::radiosity;
    add_material(lit, 0.5, 0.25);
    add_wall(lit, -5);

    EXPECT_NEAR(at(render(lit, kCamera, small(1)), 0, 0), 6 / kPi, 1e-6);
}

// A floor 1 m below the eye, from 20 m behind it to 20 m ahead, lit as if by its depth: E = -z.
LitScene lit_floor() {
    LitScene lit = scene_lit_by({-20, 20});
    add_material(lit, 1, 0);
    // The two texels' centres, between which light is linear, lie at the floor's ends.
    const glm::dvec2 behind(0.25, 0.5), ahead(0.75, 0.5);
    add_triangle(lit, {{-90, -1, 20}, {90, -1, 20}, {90, -1, -20}}, {behind, behind, ahead});
    add_triangle(lit, {{-90, -1, 20}, {90, -1, -20}, {-90, -1, -20}}, {behind, ahead, ahead});
    return lit;
}

TEST(Render, LightIsInterpolatedInTheWorldNotInThePicture) {
    RenderSettings settings = small(10);
    settings.shown = Shown::irradiance;

    const Lightmap picture = render(lit_floor(), kCamera, settings);

    for (std::uint32_t y = 6; y < 10; ++y) {
        const double down = (y + 0.5) / 5 - 1;  // of a ray that goes 1 m ahead
        EXPECT_NEAR(at(picture, 3, y), 1 / down, 1e-5) << y;
    }
}

TEST(Render, WhatPassesTheEyeIsCutThere) {
    Camera down = kCamera;
    down.forward = {0, -0.8, -0.6};
    down.up = {0, 0.6, -0.8};

    const Lightmap picture = render(lit_floor(), down, small(8));

    EXPECT_EQ(picture.coverage[0], 1.0f);
    EXPECT_EQ(picture.coverage[8 * 8 - 1], 1.0f);
}

TEST(Render, WhereNothingIsSeenCoverageIsNone) {
    const Lightmap picture = render(lit_floor(), kCamera, small(10, 2));

    EXPECT_EQ(picture.coverage[0], 0.0f);
    EXPECT_EQ(at(picture, 0, 0), 0);
    EXPECT_EQ(picture.coverage[99], 1.0f);
}

TEST(Render, APixelAtAnEdgeIsTheMeanOfWhatItShows) {
    LitScene lit = scene_lit_by({kPi});
    add_material(lit, 1, 0);
    // The left half of the picture and a quarter of its middle pixel.
    add_triangle(lit, {{-50, -50, -1}, {-1.0 / 6, -50, -1}, {-1.0 / 6, 50, -1}});
    add_triangle(lit, {{-50, -50, -1}, {-1.0 / 6, 50, -1}, {-50, 50, -1}});

    const Lightmap picture = render(lit, kCamera, small(3, 4));

    EXPECT_EQ(picture.coverage[4], 0.25f);
    EXPECT_NEAR(at(picture, 1, 1), 1, 1e-6);
}

TEST(Render, ALayerShowsItsOwnLightAndNoLamps) {
    LitScene lit = scene_lit_by({6});
    lit.lightmaps[0].layers["left"].values = {{2}};
    add_material(lit, 0.5, 0.25);
    add_wall(lit, -5);
    RenderSettings settings = small(1);
    settings.layer = "left";

    EXPECT_NEAR(at(render(lit, kCamera, settings), 0, 0), 0.5 * 2 / kPi, 1e-6);
}

TEST(Render, ALayerThatIsNotThereIsRefusedWithThoseThatAre) {
    LitScene lit = scene_lit_by({6});
    lit.exr = "lit.exr";
    lit.lightmaps[0].layers["left"].values = {{2}};
    RenderSettings settings = small(1);
    settings.layer = "right";

    try {
        render(lit, kCamera, settings);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "lit.exr: has no layer \"right\"; it has left");
    }
}

TEST(Render, TheCamerasUpIsThePicturesUp) {
    LitScene lit = scene_lit_by({kPi});
    add_material(lit, 1, 0);
    add_triangle(lit, {{-50, 0, -1}, {50, 0, -1}, {0, 50, -1}});

    const Lightmap picture = render(lit, kCamera, small(4));

    EXPECT_EQ(picture.coverage[1], 1.0f);
    EXPECT_EQ(picture.coverage[13], 0.0f);
}

}  // namespace
}  // namespace hemirad::render_test
