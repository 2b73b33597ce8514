#include "solver/ambient.h"

#include <gtest/gtest.h>

#include <numbers>

#include "solver/support.h"

// In the furnace, where B = E / (1 - rho) in the end, what is unshot is known to arrive evenly.
namespace hemirad::test::ambient_test {
namespace {

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class AmbientAfterShots : public testing::TestWithParam<std::uint64_t> {};

INSTANTIATE_TEST_SUITE_P(OfSixWalls, AmbientAfterShots, testing::Values(0, 1, 3, 6, 20));

TEST_P(AmbientAfterShots, MakesUpForWhatIsStillUnshot) {
    const Mesh mesh = meshed(scene_named("furnace.obj"), 1);
    const double reflectance = mesh.materials[0].reflectance[0];
    const double radiosity = std::numbers::pi / (1 - reflectance);

    const Solution so_far = solution_of(mesh, settings(256, 1e-9, GetParam()));
    const Solution interim = with_ambient(mesh, so_far);

    EXPECT_EQ(so_far.shots, GetParam());
    EXPECT_LT(mean(so_far.radiosity[0]), 0.999 * radiosity);
    EXPECT_NEAR(mean(interim.radiosity[0]) / radiosity, 1, 1e-5);
    EXPECT_NEAR(mean(interim.irradiance[0]) / radiosity, 1, 1e-5);
    if (GetParam() == 0) {
        for (const double value : interim.radiosity[0]) EXPECT_NEAR(value / radiosity, 1, 1e-5);
    }
}

}  // namespace
}  // namespace hemirad::test::ambient_test
