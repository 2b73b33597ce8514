#include <gtest/gtest.h>

#include "reference/monte_carlo.h"
#include "reference/ray_caster.h"
#include "solver/support.h"
#include "solver/view_factors.h"

// View factors past blockers against rays, which know nothing of projections and closed forms.
namespace hemirad::test::occluded_test {
namespace {

constexpr std::uint64_t kRays = 10'000'000;

std::vector<reference::Polygon> polygons_of(const Mesh& mesh) {
    std::vector<reference::Polygon> polygons;
    for (const Patch& patch : mesh.patches) {
        auto& polygon = polygons.emplace_back();
        for (std::size_t k = 0; k < 4; ++k) polygon.corners[k] = mesh.vertices[patch.corners[k]];
    }
    return polygons;
}

// Rays within three of their standard errors, and the target.
void expect_rays_agree(const Mesh& mesh, double target, std::uint32_t step) {
    ViewFactorSettings how;
    how.target_error = target;
    for (std::uint32_t patch = 5; patch < mesh.patches.size(); patch += step)
        how.from.push_back(patch);
    const auto factors = view_factors(mesh, how, mp1map::Device::open(""),
                                      [](std::size_t, std::size_t) { return true; });
    const auto polygons = polygons_of(mesh);
    const reference::RayCaster caster(polygons);
    for (std::size_t row = 0; row < how.from.size(); ++row) {
        const auto rays = reference::monte_carlo_factors(polygons[how.from[row]], polygons.size(),
                                                         caster, kRays, 7 + row);
        for (std::uint32_t to = 0; to < polygons.size(); ++to)
            EXPECT_NEAR(factors.at(row, to), rays.values[to], 3 * rays.standard_errors[to] + target)
                << "from " << how.from[row] << " to " << to;
    }
}

TEST(LongOccluded, FactorsInAFurnishedRoomAreThoseOfRays) {
    const Mesh mesh = meshed(furnished_room(), 1.0);
    for (const double target : {1e-3, 1e-4}) expect_rays_agree(mesh, target, 61);
}

TEST(LongOccluded, FactorsAmongSheetsAreThoseOfRays) {
    auto polygons = soup(200, 0.5, 9);
    const std::size_t fronts = polygons.size();
    for (std::size_t i = 0; i < fronts; ++i) {
        auto back = polygons[i];
        std::swap(back.corners[1], back.corners[2]);
        back.corners[3] = back.corners[2];
        if (i > 0) polygons.push_back(back);
    }
    const Mesh mesh = mesh_of(polygons);
    for (const double target : {1e-3, 1e-4}) expect_rays_agree(mesh, target, 97);
}

}  // namespace
}  // namespace hemirad::test::occluded_test
