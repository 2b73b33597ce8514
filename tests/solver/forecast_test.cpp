#include <gtest/gtest.h>

#include "solver/solved.h"
#include "solver/support.h"

// What a solve will take, told before it begins, against what it took.
namespace hemirad::test::forecast_test {
namespace {

struct Ended {
    Solved solved;
    std::optional<Forecast> forecast;
};

Ended ended(const Mesh& mesh, const SolverSettings& how, bool is_foretold) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    Ended result;
    if (is_foretold) result.forecast = solver.forecast();
    solver.solve(go_on);
    result.solved = {solver.solution(), solver.closure(), solver.repeated_shots()};
    return result;
}

void expect_shots_foretold(const Mesh& mesh, const SolverSettings& how, double bound) {
    const auto end = ended(mesh, how, true);
    const auto shots = static_cast<double>(end.solved.solution.shots);
    EXPECT_NEAR(end.forecast->shots / shots, 1, bound) << shots;
    EXPECT_LE(end.forecast->looks, end.forecast->shots);
    EXPECT_GT(end.forecast->seconds, 0);
}

SolverSettings draft() {
    auto result = settings(128);
    result.form_factor = FormFactorMode::analytic;
    return result;
}

Mesh box() { return meshed(scene_named("cornell.gltf"), 0.1); }

TEST(Forecast, ShotsOfAClosedBoxAreForetold) { expect_shots_foretold(box(), draft(), 0.05); }

TEST(Forecast, ShotsOfTwoRoomsAreForetold) {
    expect_shots_foretold(meshed(scene_named("lroom.obj"), 0.84), draft(), 0.1);
}

TEST(Forecast, ShotsOfWhatIsOpenAreForetold) {
    expect_shots_foretold(meshed(scene_named("squares.obj"), 0.1), draft(), 0.1);
}

TEST(Forecast, ShotsOfPatchesInElementsAreForetold) {
    MeshSettings sizes;
    sizes.patch_size = 0.2;
    sizes.element_size = 0.1;
    expect_shots_foretold(build_mesh(scene_named("cornell.gltf"), sizes), draft(), 0.1);
}

TEST(Forecast, ChangesNoBit) {
    auto how = draft();
    how.salvo = 8;
    how.count_shots = true;
    expect_equal(ended(box(), how, true).solved, ended(box(), how, false).solved);
}

TEST(Forecast, ShotsAreNoMoreThanAllowed) {
    auto how = draft();
    how.max_shots = 40;
    const auto forecast = ended(box(), how, true).forecast;
    EXPECT_EQ(forecast->shots, 40);
    EXPECT_LE(forecast->looks, 40);
}

TEST(Forecast, WithoutRoomForRowsEveryShotLooks) {
    auto how = draft();
    how.row_bytes = 0;
    const auto forecast = ended(box(), how, true).forecast;
    EXPECT_EQ(forecast->looks, forecast->shots);
}

TEST(Forecast, SaysNothingOfWhatIsShortOrStopped) {
    const auto mesh = box();
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, draft(), device);
    EXPECT_FALSE(solver.forecast(1e9));
    EXPECT_FALSE(solver.forecast(0, [] { return false; }));
    EXPECT_TRUE(solver.forecast());
}

}  // namespace
}  // namespace hemirad::test::forecast_test
