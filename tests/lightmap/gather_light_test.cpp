#include "lightmap/gather_light.h"

#include <cmath>
#include <functional>

#include "lightmap/patch_lookup.h"
#include "lightmap/rasterize.h"
#include "lightmap/support.h"
#include "scene/scenes_by_hand.h"

// Which texels are gathered, and what the others get, of light that a formula gives.
namespace hemirad::gather_light_test {
namespace {

using Light = std::function<double(const glm::dvec3&)>;

constexpr double kError = 0.01;

struct Gathered {
    Mesh mesh;
    ChartLayout layout;
    Lightmap lightmap;  ///< as rasterized from the patches, then the gathered light in its place
    GatheredLight light;

    const Surface& surface(std::uint32_t chart) const {
        return mesh.surfaces[layout.charts[chart].surface];
    }
    glm::dvec3 point(std::uint32_t chart, double x, double y) const {
        const Chart& of = layout.charts[chart];
        return surface(chart).origin + (x + 0.5) * of.texel_size.x * surface(chart).u_axis +
               (of.height - y - 0.5) * of.texel_size.y * surface(chart).v_axis;
    }
    double at(std::uint32_t chart, int x, int y) const {
        const Chart& of = layout.charts[chart];
        return light.irradiance[0][texel_at(lightmap, of.x + static_cast<std::uint32_t>(x),
                                            of.y + static_cast<std::uint32_t>(y))];
    }
    /// |gathered - true| over the true light, of the chart's texels.
    double largest_error(std::uint32_t chart, const Light& truth) const {
        double largest = 0;
        for (std::uint32_t y = 0; y < layout.charts[chart].height; ++y)
            for (std::uint32_t x = 0; x < layout.charts[chart].width; ++x) {
                const double expected = truth(point(chart, x, y));
                largest = std::max(
                    largest, std::abs(at(chart, int(x), int(y)) - expected) / std::abs(expected));
            }
        return largest;
    }
};

/// `seen`: the light that the solve knows of, at the patches' centroids.
Gathered gather(const Scene& scene, double patch_size, double texel_size, const Light& light,
                const Light& seen, double error = kError) {
    Gathered result{build_mesh(scene, {.patch_size = patch_size}), {}, {}, {}};
    std::vector<double> values;
    for (const Patch& patch : result.mesh.patches)
        values.push_back(seen(result.mesh.centroid(patch)));
    result.layout = lay_out_charts(result.mesh, {.texel_size = texel_size});
    result.lightmap =
        rasterize(result.mesh, solution_of(values), result.layout, Quantity::irradiance);
    result.light =
        *gather_light(result.mesh, result.layout, 0, {values}, error,
                      [&](std::span<const SurfacePoint> points, const TexelProgress&) {
                          std::vector<double> found;
                          for (const SurfacePoint& point : points)
                              found.push_back(light(point.position));
                          return std::make_optional(std::vector<std::vector<double>>{found});
                      });
    return result;
}

Gathered gather(const Scene& scene, double patch_size, double texel_size, const Light& light) {
    return gather(scene, patch_size, texel_size, light, light);
}

Scene floor_of(double x0, double y0, double x1, double y1) {
    Scene scene = empty_scene();
    scene.objects = {"floor", "wall", "tile"};
    add_face(scene, rectangle(x0, y0, x1, y1));
    return scene;
}

double dome(const glm::dvec3& at) {
    return 2 + std::cos(0.8 * (at.x - 2)) * std::cos(0.7 * (at.y - 1.5));
}

TEST(GatherLight, SmoothLightIsGatheredAtFewTexelsAndInterpolatedWithinTheError) {
    const auto gathered = gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, dome);

    EXPECT_EQ(gathered.light.gathered + gathered.light.interpolated, 64u * 64);
    EXPECT_LT(gathered.light.gathered, 64u * 64 / 8);
    EXPECT_LT(gathered.largest_error(0, dome), kError);
}

TEST(GatherLight, WithoutAnErrorEveryTexelIsGatheredAtItsCentre) {
    const auto gathered = gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, dome, dome, 0);

    EXPECT_EQ(gathered.light.gathered, 64u * 64);
    EXPECT_EQ(gathered.light.interpolated, 0u);
    EXPECT_LT(gathered.largest_error(0, dome), 1e-6);
}

TEST(GatherLight, AShadowsEdgeIsGathered) {
    const Light shadow = [](const glm::dvec3& at) { return at.x + 0.3 * at.y < 2.4 ? 1.0 : 6.0; };

    const auto gathered = gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, shadow);

    EXPECT_LT(gathered.largest_error(0, shadow), 1e-6);
    EXPECT_LT(gathered.light.gathered, 64u * 64 / 3);
}

// Between the texels that a cell starts from.
TEST(GatherLight, AStripeThatThePatchesKnowOfIsGathered) {
    const Light stripe = [](const glm::dvec3& at) { return at.x > 1.15 && at.x < 1.4 ? 1.0 : 2.0; };
    const Light even = [](const glm::dvec3&) { return 2.0; };

    EXPECT_LT(gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, stripe).largest_error(0, stripe), 1e-6);
    EXPECT_GT(gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, stripe, even).largest_error(0, stripe),
              0.5);
}

// It ends on the floor, so both of its sides are one region. Light differs by less than the error
// and so asks for no cut itself.
TEST(GatherLight, NothingIsInterpolatedAcrossAWall) {
    Scene scene = floor_of(0, 0, 4, 4);
    const std::vector<glm::dvec3> wall{{1.7, 0, 0}, {1.7, 3, 0}, {1.7, 3, 1}, {1.7, 0, 1}};
    add_face(scene, wall, 0, 1);
    add_face(scene, reversed(wall), 0, 1);
    const Light light = [](const glm::dvec3& at) { return at.x < 1.7 ? 2.0 : 2.01; };

    const auto gathered = gather(scene, 0.5, 0.1, light);

    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x) {
            const auto at = gathered.point(0, x, y);
            if (at.y > 3) continue;
            EXPECT_NEAR(gathered.at(0, x, y), light(at), 1e-6) << at.x << ' ' << at.y;
        }
    EXPECT_GT(gathered.light.interpolated, 0u);
}

TEST(GatherLight, APointKeepsOffTheFootOfAWallThatItsTexelLiesAcross) {
    Scene scene = floor_of(0, 0, 4, 2);
    const std::vector<glm::dvec3> wall{{2, 0, 0}, {2, 2, 0}, {2, 2, 1}, {2, 0, 1}};
    add_face(scene, wall, 0, 1);
    add_face(scene, reversed(wall), 0, 1);
    double nearest = 1;  // of texels whose centres lie at 0.4, 1.2, 2.0, ...
    const Light light = [&](const glm::dvec3& at) {
        if (at.z == 0) nearest = std::min(nearest, std::abs(at.x - 2));
        return 1.0;
    };

    gather(scene, 0.5, 0.8, light, [](const glm::dvec3&) { return 1.0; });

    EXPECT_GT(nearest, 1e-3);
    EXPECT_LT(nearest, 1e-2);
}

TEST(GatherLight, WhatLiesUnderABlockShowsTheLightBesideIt) {
    Scene scene = floor_of(0, 0, 4, 4);
    for (const auto& face : solid_box({1.3, 1.2, 0}, {2.9, 2.7, 1})) add_face(scene, face, 0, 1);
    const Light light = [](const glm::dvec3& at) {
        return at.z == 0 && at.x > 1.3 && at.x < 2.9 && at.y > 1.2 && at.y < 2.7 ? 0.0 : 5.0;
    };
    const Light five = [](const glm::dvec3&) { return 5.0; };

    EXPECT_LT(gather(scene, 0.5, 0.1, light).largest_error(0, five), 1e-6);
}

TEST(GatherLight, AGutterShowsTheNearestTexel) {
    const auto gathered = gather(floor_of(0, 0, 4, 4), 0.25, 0.0625, dome);

    for (int k = 1; k <= int(kDefaultPadding); ++k) {
        EXPECT_EQ(gathered.at(0, -k, 20), gathered.at(0, 0, 20));
        EXPECT_EQ(gathered.at(0, 33, 63 + k), gathered.at(0, 33, 63));
    }
    EXPECT_EQ(gathered.lightmap.coverage[texel_at(gathered.lightmap, 0, 0)], 0);
}

TEST(GatherLight, WhereThePlaneGoesOnTheGutterHasTheLightOfTheNextChart) {
    Scene scene = floor_of(0, 0, 2, 2);
    add_face(scene, rectangle(2, 0, 4, 2), 0, 2);

    const auto gathered = gather(scene, 0.25, 0.0625, dome);

    for (int y = 0; y < 32; ++y) {
        EXPECT_NEAR(gathered.at(0, 32, y), dome(gathered.point(0, 32, y)), 1e-6);
        EXPECT_NEAR(gathered.at(1, -1, y), dome(gathered.point(1, -1, y)), 1e-6);
        EXPECT_EQ(
            gathered.mesh
                .patches[gathered.light
                             .patch[texel_at(gathered.lightmap, gathered.layout.charts[0].x + 32,
                                             gathered.layout.charts[0].y + std::uint32_t(y))]]
                .surface,
            gathered.layout.charts[0].surface);
    }
}

TEST(GatherLight, TexelsOnASlantedOutlineAreGatheredInsideIt) {
    Scene scene = empty_scene();
    add_face(scene, {{0, 0, 0}, {4, 0, 0}, {1, 3, 0}});
    bool is_inside = true;
    const Light light = [&](const glm::dvec3& at) {
        is_inside = is_inside && at.y > 0 && at.x + at.y < 4 && 3 * at.x > at.y;
        return dome(at);
    };

    const auto gathered = gather(scene, 0.5, 0.0625, light, dome);

    EXPECT_TRUE(is_inside);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < gathered.lightmap.texel_count(); ++i) {
        if (gathered.lightmap.coverage[i] == 0) continue;
        ++covered;
        EXPECT_NEAR(gathered.light.irradiance[0][i], gathered.lightmap.values[0][i], 0.15);
    }
    EXPECT_EQ(gathered.light.gathered + gathered.light.interpolated, covered);
}

TEST(GatherLight, StopsWhereItIsTold) {
    const Mesh mesh = build_mesh(floor_of(0, 0, 4, 4), {.patch_size = 1});
    const std::vector<std::vector<double>> light(1, std::vector<double>(mesh.patches.size(), 1));

    EXPECT_FALSE(gather_light(mesh, lay_out_charts(mesh), 0, light, kError,
                              [](std::span<const SurfacePoint>, const TexelProgress&) {
                                  return std::optional<std::vector<std::vector<double>>>();
                              }));
}

}  // namespace
}  // namespace hemirad::gather_light_test
