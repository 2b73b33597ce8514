#include <gtest/gtest.h>

#include "solver/support.h"

// Energy is neither made nor lost: emitted = absorbed + escaped + unshot in every band, and no
// proxel of a shot is without owner or with two.
namespace hemirad::test::ledger_test {
namespace {

struct Case {
    const char* file;
    double patch_size;  ///< m; 0: the scene's own
    double tolerance;
    bool closed;
};

std::ostream& operator<<(std::ostream& out, const Case& scene) { return out << scene.file; }

class Ledgers : public testing::TestWithParam<Case> {};

INSTANTIATE_TEST_SUITE_P(
    Scenes, Ledgers,
    testing::Values(Case{"furnace.obj", 0.25, 1e-3, true}, Case{"squares.obj", 0.1, 1e-3, false},
                    Case{"cornell.gltf", 0, 1e-2, false}, Case{"lroom.obj", 0, 2e-2, true},
                    Case{"hall2k.obj", 0, 1e-1, true}, Case{"hall14k.obj", 0, 3e-1, true}));

TEST_P(Ledgers, AddUpInEveryBand) {
    const Mesh mesh = meshed(scene_named(GetParam().file), GetParam().patch_size);
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, settings(128, GetParam().tolerance), device);

    const Stop stop = solver.solve(go_on);
    const Solution solution = solver.solution();

    EXPECT_EQ(stop, Stop::converged);
    EXPECT_EQ(mesh.closed, GetParam().closed);
    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    ASSERT_EQ(solution.ledger.size(), 3u);
    for (std::size_t band = 0; band < 3; ++band) {
        const Ledger& ledger = solution.ledger[band];
        EXPECT_LT(ledger.residual(), 1e-5);
        EXPECT_NEAR(ledger.emitted / emitted_flux(mesh, band), 1, 1e-12);
        EXPECT_LT(ledger.unshot / ledger.emitted, GetParam().tolerance);
        if (GetParam().closed)
            EXPECT_EQ(ledger.escaped, 0);
        else
            EXPECT_GT(ledger.escaped, 0);
    }
}

TEST(Ledger, IsClosedInTheMiddleOfASolve) {
    const Mesh mesh = meshed(scene_named("cornell.gltf"), 0.11);
    const auto device = mp1map::Device::open("");
    auto how = settings(128);
    how.stop_every = {7};
    ProgressiveSolver solver(mesh, how, device);

    std::vector<double> absorbed;
    solver.solve([&](const Progress& progress) {
        const Solution solution = solver.solution();
        EXPECT_EQ(solution.shots, progress.shots);
        EXPECT_FLOAT_EQ(static_cast<float>(solution.unshot_fraction),
                        static_cast<float>(progress.unshot_fraction));
        double unshot = 0;
        for (const auto& ledger : solution.ledger) {
            EXPECT_LT(ledger.residual(), 1e-5) << "after " << progress.shots << " shots";
            unshot = std::max(unshot, ledger.unshot / ledger.emitted);
        }
        EXPECT_NEAR(unshot, solution.unshot_fraction, 1e-6);
        absorbed.push_back(solution.ledger[0].absorbed);
        return absorbed.size() < 30;
    });

    ASSERT_EQ(absorbed.size(), 30u);
    EXPECT_TRUE(std::is_sorted(absorbed.begin(), absorbed.end()));
}

TEST(Ledger, AbsorbedFluxIsWhatThePatchesSayThemselves) {
    const Mesh mesh = meshed(furnished_room(), 0.75);

    const Solution solution = solution_of(mesh, settings(128, 1e-4));

    for (std::size_t band = 0; band < 3; ++band) {
        double absorbed = 0, reflected_and_own = 0;
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            const double area = mesh.area(mesh.patches[i]);
            const double irradiance = solution.irradiance[band][i];
            absorbed += (1 - double{reflectance(mesh, mesh.patches[i], band)}) * irradiance * area;
            reflected_and_own += (solution.radiosity[band][i] - irradiance) * area;
        }
        // Radiosity less irradiance is own emission less what is absorbed.
        EXPECT_NEAR(absorbed / solution.ledger[band].absorbed, 1, 1e-9);
        EXPECT_NEAR(reflected_and_own / solution.ledger[band].emitted, 1e-4, 1e-4);
    }
}

}  // namespace
}  // namespace hemirad::test::ledger_test
