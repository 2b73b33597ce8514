#include "lightmap/light_blend.h"

#include <ctime>

#include "lightmap/support.h"
#include "support/seconds_since.h"

namespace hemirad::light_blend_test {
namespace {

/// Adds a surface of one cell, a metre a side, to those in the plane z = 0.
void add_square(Mesh& mesh, const glm::dvec2& at) {
    add_rectangle(mesh, 1, 1);
    Surface& surface = mesh.surfaces.back();
    surface.plane = 0;
    surface.origin = {at, 0};
    for (const std::uint32_t corner : mesh.patches.back().corners)
        mesh.vertices[corner] += surface.origin;
}

TEST(LightBlend, GoesOnToTheFirstOfSurfacesThatLieBeyond) {
    Mesh mesh;
    add_square(mesh, {1.0, 0});
    add_square(mesh, {1.25, 0});
    add_square(mesh, {0.75, 0});
    add_square(mesh, {0, 0});
    const std::vector<bool> hidden(mesh.patches.size(), false);

    const LightBlend blend(mesh, hidden, LightBlend::Across::all_materials);

    EXPECT_EQ(blend.beyond(3, {1.5, 0.5}), 0u);
    EXPECT_EQ(blend.beyond(3, {0.8, 0.5}), 2u);
}

TEST(LightBlend, FindsNeighboursInAPlaneOfThousandsOfSurfacesSoon) {
    Mesh mesh;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) add_square(mesh, {4 * x, 4 * y});
    const std::vector<bool> hidden(mesh.patches.size(), false);
    const auto start = std::clock();

    const LightBlend blend(mesh, hidden, LightBlend::Across::all_materials);

    EXPECT_LT(test::seconds_since(start), 2.0);
    EXPECT_EQ(blend.beyond(0, {1.5, 0.5}), kNoPatch);
}

}  // namespace
}  // namespace hemirad::light_blend_test
