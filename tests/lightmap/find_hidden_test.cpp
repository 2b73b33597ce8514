#include "lightmap/find_hidden.h"

#include <ctime>

#include "lightmap/support.h"
#include "support/seconds_since.h"

namespace hemirad::find_hidden_test {
namespace {

/// Of squares of 1 m that share their corners, `count` a side.
Mesh floor_of(std::uint32_t count) {
    Mesh mesh;
    add_surface(mesh, count, count, {1, 1});
    for (std::uint32_t y = 0; y <= count; ++y)
        for (std::uint32_t x = 0; x <= count; ++x) add_vertex(mesh, {x, y, 0});
    Surface& surface = mesh.surfaces.back();
    for (std::uint32_t cell = 0; cell < count * count; ++cell) {
        const std::uint32_t low = cell / count * (count + 1) + cell % count, high = low + count + 1;
        mesh.patches.push_back({{low, low + 1, high + 1, high}, 0});
        surface.cell_of_patch.push_back(cell);
    }
    surface.patch_count = count * count;
    surface.side_of_patch.assign(surface.patch_count, 0);
    return mesh;
}

/// Looks up, so that what is beneath sees its back.
void add_lid(Mesh& mesh, const glm::dvec3& from, const glm::dvec2& size) {
    add_rectangle(mesh, 1, 1, size);
    mesh.surfaces.back().origin = from;
    for (const std::uint32_t corner : mesh.patches.back().corners) mesh.vertices[corner] += from;
}

TEST(FindHidden, FindsInALargeFloorSoonWhatLiesUnderALid) {
    constexpr std::uint32_t kCount = 300;
    Mesh mesh = floor_of(kCount);
    add_lid(mesh, {150, 0, 0.5}, {150, kCount});
    std::vector<bool> expected(mesh.patches.size(), false);
    for (std::uint32_t y = 3; y < 270; y += 6)
        for (std::uint32_t x = 3; x < 270; x += 6) {
            mesh.surfaces[0].side_of_patch[y * kCount + x] = 1;
            expected[y * kCount + x] = x >= 150;
        }
    const auto start = std::clock();

    const auto hidden = find_hidden(mesh);

    EXPECT_LT(test::seconds_since(start), 1.5);
    EXPECT_EQ(hidden, expected);
}

}  // namespace
}  // namespace hemirad::find_hidden_test
