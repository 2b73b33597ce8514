#include "solver/gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightmap/gather_light.h"
#include "lightmap/patch_lookup.h"
#include "lightmap/surface_layers.h"
#include "reference/closed_forms.h"
#include "solver/support.h"

// Texels that look for themselves.
namespace hemirad::test::gather_test {
namespace {

using Bands = std::vector<std::vector<double>>;

// Kernels take seconds to compile: all look through the same.
GatherSettings through(FormFactorMode form_factor = FormFactorMode::analytic,
                       const mp1map::PeArrayRequest& pe_array = {}) {
    GatherSettings settings;
    settings.resolution = 64;
    settings.form_factor = form_factor;
    settings.pe_array = pe_array;
    return settings;
}

GatheredLight gathered_light(const Mesh& mesh, const Bands& radiosity, const Bands& irradiance,
                             const ChartLayout& layout, const GatherSettings& settings,
                             double error) {
    const auto device = mp1map::Device::open("");
    Gather gather(mesh, radiosity, settings, device);
    return *gather_light(mesh, layout, 0, irradiance, error,
                         [&](std::span<const SurfacePoint> points, const TexelProgress&) {
                             return gather.irradiance(points, [](std::size_t) { return true; });
                         });
}

/// As if 5 W/m^2 fell on every patch.
Bands roughly_lit(const Mesh& mesh) {
    Bands radiosity = emitted_radiosities(mesh);
    for (std::size_t band = 0; band < radiosity.size(); ++band)
        for (std::size_t i = 0; i < mesh.patches.size(); ++i)
            radiosity[band][i] += 5 * reflectance(mesh, mesh.patches[i], band);
    return radiosity;
}

TEST(Gather, AFurnaceIsEquallyBrightInEveryTexel) {
    const Mesh mesh = meshed(scene_named("furnace.obj"), 0.5);
    const double reflected = reflectance(mesh, mesh.patches[0], 0);
    const double expected = std::numbers::pi / (1 - reflected);
    const auto solution = solution_of(mesh, settings(128, 1e-5));
    const auto layout = lay_out_charts(mesh, {.texel_size = 0.1});

    for (const auto form_factor : {FormFactorMode::analytic, FormFactorMode::count}) {
        const auto light = gathered_light(mesh, solution.radiosity, solution.irradiance, layout,
                                          through(form_factor), 0);

        EXPECT_EQ(light.gathered, 6u * 10 * 10);
        for (const auto& band : light.irradiance)
            for (std::size_t texel = 0; texel < band.size(); ++texel)
                if (light.patch[texel] != kNoPatch) {
                    EXPECT_NEAR(band[texel] / expected, 1, 2e-3) << texel;
                }
    }
}

/// A floor, and a lamp of 1 m^2 above it.
Scene lamp_over_floor() {
    Scene scene = empty_scene();
    scene.objects = {"floor", "lamp"};
    scene.materials = {grey(), {"lamp", {0.0}, {2.0}, false}};
    add_face(scene, rectangle(0, 0, 4, 4));
    add_face(scene, {{1.5, 1, 1.3}, {1.5, 2, 1.3}, {2.5, 2, 1.3}, {2.5, 1, 1.3}}, 1, 1);
    return scene;
}

TEST(Gather, AFloorUnderALampHasTheClosedFormInEveryTexel) {
    const Mesh mesh = meshed(lamp_over_floor(), 0.5, Backfaces::cull);
    const auto layout = lay_out_charts(mesh, {.texel_size = 0.25});
    const auto positions = position_layer(mesh, layout), normals = normal_layer(mesh, layout);
    const std::vector<glm::dvec3> lamp{{1.5, 1, 1.3}, {1.5, 2, 1.3}, {2.5, 2, 1.3}, {2.5, 1, 1.3}};

    const Bands emission = emitted_radiosities(mesh);

    const auto light = gathered_light(mesh, emission, emission, layout, through(), 0);

    std::size_t compared = 0;
    for (std::size_t texel = 0; texel < light.patch.size(); ++texel) {
        const glm::dvec3 at(positions.values[0][texel], positions.values[1][texel],
                            positions.values[2][texel]);
        if (normals.values[2][texel] != 1 || at.x < 0 || at.y < 0 || at.x > 4 || at.y > 4) continue;
        const double factor = reference::point_to_polygon(at, {0, 0, 1}, lamp);
        EXPECT_NEAR(light.irradiance[0][texel] / (2 * std::numbers::pi * factor), 1, 1e-3);
        ++compared;
    }
    EXPECT_EQ(compared, 16u * 16);
}

std::vector<SurfacePoint> points_of(const Mesh& mesh) {
    std::vector<SurfacePoint> points;
    for (std::uint32_t i = 0; i < mesh.patches.size(); ++i)
        points.push_back({mesh.centroid(mesh.patches[i]), i, i * 2654435769u});
    return points;
}

Bands irradiance_by(const Mesh& mesh, const Bands& radiosity, const GatherSettings& settings,
                    std::span<const SurfacePoint> points, std::uint32_t compute_units = 0) {
    const auto device = mp1map::Device::open("", compute_units);
    Gather gather(mesh, radiosity, settings, device);
    return *gather.irradiance(points, [](std::size_t) { return true; });
}

const mp1map::PeArrayRequest kFineTiles{2, 1, 4, 8, 8};

TEST(Gather, HasTheSameBitsOnEveryMachine) {
    const Mesh mesh = meshed(furnished_room(), 0.8);
    const Bands radiosity = roughly_lit(mesh);
    const auto points = points_of(mesh);
    const auto first = irradiance_by(mesh, radiosity, through(), points);
    const auto on = [&](const mp1map::PeArrayRequest& pe_array, std::uint32_t compute_units) {
        return irradiance_by(mesh, radiosity, through(FormFactorMode::analytic, pe_array), points,
                             compute_units);
    };

    if (mp1map::Device::open("").summary().is_divisible) {
        EXPECT_EQ(first, on({}, 1));
    }
    EXPECT_EQ(first, on(kFineTiles, 0));
}

// Lists are sized for patches that touch few tiles; those who find no room are asked again.
TEST(Gather, HasTheSameBitsWhereTheListsHadNoRoom) {
    Mesh mesh = mesh_of(soup(20000, 1.0, 5), 0.7);
    for (const Patch& patch : mesh.patches)
        mesh.surfaces[patch.surface].u_axis =
            glm::normalize(mesh.vertices[patch.corners[1]] - mesh.vertices[patch.corners[0]]);
    const Bands radiosity{std::vector<double>(mesh.patches.size(), 1.0)};
    auto points = points_of(mesh);
    points.resize(11);
    const auto seen = [&](const mp1map::PeArrayRequest& pe_array) {
        return irradiance_by(mesh, radiosity, through(FormFactorMode::analytic, pe_array), points);
    };

    const Bands first = seen({});

    EXPECT_GT(first[0][0], 0.1);  // of patch 0, which looks at all of them
    EXPECT_EQ(first, seen(kFineTiles));
}

/// In a large scene one takes a second.
TEST(Gather, MayBeStoppedAfterTheFirstSalvo) {
    const Mesh mesh = meshed(furnished_room(), 0.5);
    const auto points = points_of(mesh);
    ASSERT_GT(points.size(), 4 * kMostSalvo);
    const auto device = mp1map::Device::open("");
    Gather gather(mesh, roughly_lit(mesh), through(), device);
    std::size_t gathered = 0;

    const auto light = gather.irradiance(points, [&](std::size_t done) {
        gathered += done;
        return false;
    });

    EXPECT_EQ(light, std::nullopt);
    EXPECT_LE(gathered, kMostSalvo);
}

TEST(Gather, APointHasTheSameBitsInAnyCompany) {
    const Mesh mesh = meshed(furnished_room(), 0.5);
    const Bands radiosity = roughly_lit(mesh);
    const auto points = points_of(mesh);

    const auto together = irradiance_by(mesh, radiosity, through(), points);
    const auto alone = irradiance_by(mesh, radiosity, through(), std::span(points).last(3));

    for (std::size_t band = 0; band < radiosity.size(); ++band)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(alone[band][i], together[band][points.size() - 3 + i]);
}

// Emission of what a double holds and a float does not.
TEST(Gather, IsProportionalToTheLight) {
    const Mesh mesh = meshed(lamp_over_floor(), 1, Backfaces::cull);
    const Bands radiosity{std::vector<double>(mesh.patches.size(), 1.0),
                          std::vector<double>(mesh.patches.size(), 0x1p300),
                          std::vector<double>(mesh.patches.size(), 0.0)};

    const auto light = irradiance_by(mesh, radiosity, through(), points_of(mesh));

    EXPECT_GT(*std::ranges::max_element(light[0]), 0.1);
    for (std::size_t i = 0; i < light[0].size(); ++i) {
        EXPECT_EQ(light[1][i], light[0][i] * 0x1p300);
        EXPECT_EQ(light[2][i], 0);
    }
}

TEST(Gather, InterpolatedTexelsAreWithinTheErrorOfGatheredOnes) {
    constexpr double kError = 0.02;
    const Mesh mesh = meshed(furnished_room(), 0.5);
    const Bands radiosity = roughly_lit(mesh);
    const Bands irradiance = irradiance_by(mesh, radiosity, through(), points_of(mesh));
    const auto layout = lay_out_charts(mesh, {.texel_size = 0.15});

    const auto all = gathered_light(mesh, radiosity, irradiance, layout, through(), 0);
    const auto some = gathered_light(mesh, radiosity, irradiance, layout, through(), kError);

    EXPECT_EQ(some.gathered + some.interpolated, all.gathered);
    EXPECT_LT(some.gathered, 0.7 * static_cast<double>(all.gathered));
    double mean = 0, squares = 0, texels = 0;
    for (std::size_t i = 0; i < all.patch.size(); ++i)
        if (all.patch[i] != kNoPatch) {
            mean += all.irradiance[0][i];
            squares += std::pow(double{some.irradiance[0][i]} - all.irradiance[0][i], 2);
            ++texels;
        }
    EXPECT_LT(std::sqrt(squares / texels), kError * mean / texels);
}

}  // namespace
}  // namespace hemirad::test::gather_test
