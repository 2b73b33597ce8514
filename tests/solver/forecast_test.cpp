#include <gtest/gtest.h>

#include "solver/solved.h"
#include "solver/stopwatch.h"
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

// After so many questions, also in the midst of a look.
TEST(Forecast, StoppedAnywhereChangesNoBit) {
    auto how = draft();
    how.salvo = 8;
    how.shooter_samples = 3;
    const auto mesh = box();
    const auto device = mp1map::Device::open("");
    const auto whole = ended(mesh, how, false).solved;
    for (const int most : {1, 4, 25, 300}) {
        ProgressiveSolver solver(mesh, how, device);
        int questions = 0;
        if (solver.forecast(0, [&] { return ++questions < most; })) break;
        EXPECT_EQ(questions, most);
        solver.solve(go_on);
        expect_equal({solver.solution(), solver.closure(), solver.repeated_shots()}, whole);
    }
}

TEST(Forecast, IsAskedUpToItsEnd) {
    const auto mesh = meshed(scene_named("cornell.gltf"), 0.03);
    const auto device = mp1map::Device::open("");
    auto how = draft();
    how.resolution = 512;  // some seconds in all
    how.salvo = 8;
    ProgressiveSolver solver(mesh, how, device);
    const Stopwatch stopwatch;
    double last_asked = 0;
    EXPECT_TRUE(solver.forecast(0, [&] {
        last_asked = stopwatch.seconds();
        return true;
    }));
    EXPECT_LT(stopwatch.seconds() - last_asked, stopwatch.seconds() / 4);
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

// A cube of n x n squares a side, no two of one reflectance; four of the last side emit.
Scene patchwork(int n) {
    Scene scene = empty_scene();
    scene.materials.clear();
    const auto square = [&](const std::vector<glm::dvec3>& side, int i, int j) {
        const auto at = [&](int column, int row) {
            return side[0] + (side[1] - side[0]) * (double(column) / n) +
                   (side[3] - side[0]) * (double(row) / n);
        };
        add_face(scene, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                 static_cast<std::uint32_t>(scene.materials.size()));
        scene.materials.push_back(grey(0.2 + 0.6 * double(scene.materials.size()) / (6 * n * n)));
    };
    for (const auto& side : room({0, 0, 0}, {1, 1, 1}))
        for (int i = 0; i < n * n; ++i) square(side, i % n, i / n);
    for (std::size_t k = 0; k < 4; ++k) scene.materials.rbegin()[k].emission = {10};
    return scene;
}

// Of groups there are at most as many as materials that are told apart, and as many again.
TEST(Forecast, LooksOfManyMaterialsAreFew) {
    constexpr int kMost = 2 * 256, kSide = 10;
    const auto mesh = meshed(patchwork(kSide), kUncut);
    ASSERT_EQ(mesh.patches.size(), 6u * kSide * kSide);
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, draft(), device);
    int looks = 0;
    ASSERT_TRUE(solver.forecast(0, [&] { return ++looks > 0; }));
    EXPECT_LE(looks, kMost);
    EXPECT_GT(looks, 0);
}

TEST(Forecast, ShotsOfManyMaterialsAreForetold) {
    expect_shots_foretold(meshed(patchwork(7), kUncut), draft(), 0.1);
}

}  // namespace
}  // namespace hemirad::test::forecast_test
