#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lightmap/rasterize.h"
#include "solver/gather.h"
#include "solver/support.h"

// A room without light in a hall that has some: what is shut in stays dark, to the last texel.
namespace hemirad::test::leak_test {
namespace {

/// Hall of 4 m x 4 m x 2 m with a lamp for a ceiling; in it, on its floor, a room of 1 m height.
Scene hall_with_room(double thickness) {
    Scene scene;
    scene.file = "leak";
    scene.bands = {"Y"};
    scene.objects = {"hall", "room"};
    scene.materials = {{"plaster", {0.5}, {0}, false}, {"lamp", {0.5}, {1}, false}};
    for (const auto& face : room({0, 0, 0}, {4, 4, 2}))
        add_face(scene, face, face[0].z + face[1].z + face[2].z == 6 ? 1 : 0, 0);
    const auto add_without_floor = [&](const std::vector<std::vector<glm::dvec3>>& faces) {
        for (const auto& face : faces)
            if (face[0].z + face[1].z + face[2].z > 0) add_face(scene, face, 0, 1);
    };
    const glm::dvec3 low(1.13, 1.27, 0), high(2.81, 2.63, 1), wall(thickness, thickness, 0);
    add_without_floor(solid_box(low - wall, high + wall + glm::dvec3(0, 0, thickness)));
    add_without_floor(room(low, high));
    return scene;
}

bool is_shut_in(const glm::dvec3& at) {
    return at.x > 1.13 && at.x < 2.81 && at.y > 1.27 && at.y < 2.63 && at.z < 1;
}

/// The room's texels, by their centres; the hall's are not looked at.
std::vector<double> texels_shut_in(const Mesh& mesh, const Solution& solution) {
    const auto layout = lay_out_charts(mesh);
    const Lightmap lightmap = rasterize(mesh, solution, layout, Quantity::irradiance);
    std::vector<double> values;
    for (const Chart& chart : layout.charts) {
        const Surface& surface = mesh.surfaces[chart.surface];
        for (std::uint32_t y = 0; y < chart.height; ++y)
            for (std::uint32_t x = 0; x < chart.width; ++x) {
                const glm::dvec3 at =
                    surface.origin + (x + 0.5) * chart.texel_size.x * surface.u_axis +
                    (chart.height - y - 0.5) * chart.texel_size.y * surface.v_axis;
                if (is_shut_in(at + 1e-3 * surface.normal))
                    values.push_back(lightmap.values[0][std::size_t{chart.y + y} * lightmap.width +
                                                        chart.x + x]);
            }
    }
    return values;
}

struct Way {
    double thickness;
    std::uint32_t resolution;
    FormFactorMode form_factor;
};

class SealedRoom : public testing::TestWithParam<Way> {};

std::vector<Way> ways() {
    std::vector<Way> ways;
    for (const double thickness : {0.0, 0.1})
        for (const std::uint32_t resolution : {64, 128})
            for (const auto form_factor : {FormFactorMode::analytic, FormFactorMode::count})
                ways.push_back({thickness, resolution, form_factor});
    return ways;
}

INSTANTIATE_TEST_SUITE_P(Ways, SealedRoom, testing::ValuesIn(ways()), [](const auto& way) {
    return std::string(way.param.thickness > 0 ? "Thick" : "Thin") +
           (way.param.form_factor == FormFactorMode::count ? "Counted" : "Analytic") +
           std::to_string(way.param.resolution);
});

// However coarse the plane is: strips of floor beside the walls are narrower than a proxel.
TEST_P(SealedRoom, StaysDarkOnEveryTexel) {
    const Mesh mesh = meshed(hall_with_room(GetParam().thickness), 0.4);
    SolverSettings how = settings(GetParam().resolution, 1e-2);
    how.form_factor = GetParam().form_factor;
    const Solution solution = solution_of(mesh, how);

    const auto values = texels_shut_in(mesh, solution);

    ASSERT_GT(values.size(), 200u);
    EXPECT_LT(std::ranges::max(values), 1e-6);
    EXPECT_GT(std::ranges::max(solution.irradiance[0]), 1);
}

// Points of the final gather look no further than what shoots.
TEST(SealedRooms, StayDarkWhereTexelsLookForThemselves) {
    const Mesh mesh = meshed(hall_with_room(0), 0.4);
    std::vector<std::vector<double>> radiosity(1);
    for (const Patch& patch : mesh.patches) {
        const glm::dvec3 normal = mesh.surfaces[patch.surface].normal;
        radiosity[0].push_back(is_shut_in(mesh.centroid(patch) + 1e-3 * normal) ? 0 : 1);
    }
    GatherSettings how;
    how.resolution = 32;
    Gather gather(mesh, radiosity, how, mp1map::Device::open(""));
    std::vector<SurfacePoint> points;
    for (std::uint32_t i = 0; i < mesh.patches.size(); ++i)
        if (radiosity[0][i] == 0) points.push_back({mesh.centroid(mesh.patches[i]), i, i});

    const auto irradiance = gather.irradiance(points, [](std::size_t) { return true; });

    ASSERT_TRUE(irradiance);
    ASSERT_GT(points.size(), 50u);
    EXPECT_EQ(std::ranges::max(irradiance->front()), 0);
}

// The hall as bright as it gets, the room as dark as it should be.
TEST(SealedRooms, GetNoLightFromTheLightmapOverWallsWithoutThickness) {
    const Mesh mesh = meshed(hall_with_room(0), 0.4);
    Solution solution;
    solution.bands = {"Y"};
    solution.irradiance.emplace_back();
    for (const Patch& patch : mesh.patches) {
        const glm::dvec3 normal = mesh.surfaces[patch.surface].normal;
        solution.irradiance[0].push_back(is_shut_in(mesh.centroid(patch) + 1e-3 * normal) ? 0 : 1);
    }

    const auto values = texels_shut_in(mesh, solution);

    ASSERT_GT(values.size(), 200u);
    EXPECT_EQ(std::ranges::max(values), 0);
}

}  // namespace
}  // namespace hemirad::test::leak_test
