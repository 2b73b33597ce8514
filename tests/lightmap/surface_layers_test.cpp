#include "lightmap/surface_layers.h"

#include <glm/geometric.hpp>
#include <map>

#include "lightmap/support.h"

namespace hemirad::surface_layers_test {
namespace {

glm::dvec3 vector_at(const Layer& layer, std::size_t texel) {
    return {layer.values[0][texel], layer.values[1][texel], layer.values[2][texel]};
}

/// 3 m x 2 m, turned: its first axis is y, its second z, so that it faces along x from x = 5.
struct Wall {
    Mesh mesh = rectangle(3, 2);
    ChartLayout layout;

    Wall() {
        Surface& surface = mesh.surfaces[0];
        surface.origin = {5, 10, 20};
        surface.u_axis = {0, 1, 0};
        surface.v_axis = {0, 0, 1};
        surface.normal = {1, 0, 0};
        for (auto& vertex : mesh.vertices) vertex = {5, 10 + vertex.x, 20 + vertex.y};
        layout = lay_out_charts(mesh, {.texel_size = 0.5});
    }
};

TEST(ShotsLayer, HoldsThoseOfTheTexelsPatchUnblended) {
    const Wall wall;
    std::vector<std::uint32_t> shots_of(wall.mesh.patches.size());
    for (std::uint32_t i = 0; i < shots_of.size(); ++i) shots_of[i] = 100 * i + 1;

    const Layer layer = shots_layer(wall.mesh, wall.layout, shots_of);

    ASSERT_EQ(layer.values.size(), 1u);
    std::map<float, int> found;
    const Chart& chart = wall.layout.charts[0];
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 6; ++x)
            ++found[layer.values[0][std::size_t{chart.y + y} * wall.layout.atlases[0].width +
                                    chart.x + x]];
    std::map<float, int> expected;
    for (const std::uint32_t shots : shots_of) expected[float(shots)] = 24 / int(shots_of.size());
    EXPECT_EQ(found, expected);
}

TEST(PositionLayer, HoldsTheCentreOfEachTexel) {
    const Wall wall;
    const Chart& chart = wall.layout.charts[0];

    const Layer layer = position_layer(wall.mesh, wall.layout);

    const auto at = [&](std::uint32_t x, std::uint32_t y) {
        return vector_at(layer,
                         std::size_t{chart.y + y} * wall.layout.atlases[0].width + chart.x + x);
    };
    EXPECT_LT(glm::distance(at(0, 0), {5, 10.25, 21.75}), 1e-5);
    EXPECT_LT(glm::distance(at(5, 0), {5, 12.75, 21.75}), 1e-5);
    EXPECT_LT(glm::distance(at(0, 3), {5, 10.25, 20.25}), 1e-5);
    EXPECT_TRUE(layer.exact);
}

TEST(PositionLayer, GoesOnInThePlaneWhereThereIsNoSurface) {
    const Wall wall;
    const Chart& chart = wall.layout.charts[0];
    const auto texel = std::size_t{chart.y - 2} * wall.layout.atlases[0].width + chart.x - 2;

    EXPECT_LT(
        glm::distance(vector_at(position_layer(wall.mesh, wall.layout), texel), {5, 9.25, 22.75}),
        1e-5);
}

TEST(PositionLayer, GivesBackWhereItsPointLies) {
    const Wall wall;
    const Layer layer = position_layer(wall.mesh, wall.layout);

    for (std::uint32_t y = 0; y < wall.layout.atlases[0].height; ++y)
        for (std::uint32_t x = 0; x < wall.layout.atlases[0].width; ++x) {
            const auto point = vector_at(layer, std::size_t{y} * wall.layout.atlases[0].width + x);
            if (point == glm::dvec3(0)) continue;
            const auto atlas =
                atlas_from_world(wall.layout.charts[0], wall.mesh.surfaces[0], point);
            EXPECT_LT(glm::distance(atlas, {x + 0.5, y + 0.5}), 1e-4);
        }
}

TEST(NormalLayer, HoldsTheSurfacesNormalAlsoInTheGutter) {
    const Wall wall;
    const Chart& chart = wall.layout.charts[0];

    const Layer layer = normal_layer(wall.mesh, wall.layout);

    for (const std::uint32_t back : {0u, 1u, 2u})
        EXPECT_EQ(vector_at(layer, std::size_t{chart.y - back} * wall.layout.atlases[0].width +
                                       chart.x - back),
                  glm::dvec3(1, 0, 0));
    EXPECT_EQ(layer.components, (std::vector<std::string>{"X", "Y", "Z"}));
}

}  // namespace
}  // namespace hemirad::surface_layers_test
