#include <numbers>

#include "errors.h"
#include "extremes/solves_support.h"

// Light from the weakest to the strongest that the numbers hold, and reflectances up to where a
// float ends.
namespace hemirad::test::solves_light_test {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

/// Unit cube, fronts inwards; a wall is a patch.
Scene cube(const std::vector<double>& reflectance, const std::vector<double>& emission) {
    Scene scene = scene_of(room({0, 0, 0}, {1, 1, 1}));
    scene.bands.clear();
    for (std::size_t band = 0; band < emission.size(); ++band)
        scene.bands.push_back("band" + std::to_string(band));
    scene.materials = {{"wall", reflectance, emission, false}};
    return scene;
}

Mesh uncut(const Scene& scene) {
    return build_mesh(scene, {.patch_size = 1, .backfaces = Backfaces::cull, .max_reflectance = 1});
}

double mean_irradiance(const Mesh& mesh, const Solution& solution, std::size_t band) {
    double flux = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i)
        flux += mesh.area(mesh.patches[i]) * solution.irradiance[band][i];
    return flux / total_area(mesh);
}

class Light : public testing::TestWithParam<FormFactorMode> {};

INSTANTIATE_TEST_SUITE_P(Modes, Light,
                         testing::Values(FormFactorMode::count, FormFactorMode::analytic),
                         [](const auto& mode) { return name_of(mode.param); });

// What a closed room absorbs is what it emits, less what is still to be shot. The reflectance that
// the device holds is off by half an ulp of 1, 2^-25, which 1 - rho multiplies; each of the
// roundings of a shot (factor, flux, product) by as much of the flux that was shot.
TEST_P(Light, OfAFurnaceIsTheClosedFormUpToReflectancesOfAFloat) {
    for (const double rho : {0.0, 0.5, 0.98, 1 - 1e-3, 1 - 1e-6}) {
        const Mesh mesh = uncut(cube({rho}, {1}));

        const Solution solution = solution_of(mesh, settings(64, GetParam(), 1e-3, 3000));

        expect_numbers(solution);
        const double bound = (0x1p-25 + 3 * 0x1p-24) / (1 - rho);
        const double expected = kPi / (1 - rho) * (1 - solution.unshot_fraction);
        EXPECT_NEAR(mean_irradiance(mesh, solution, 0) / expected, 1, bound) << rho;
        EXPECT_EQ(solution.converged, rho < 0.99) << rho;
    }
}

TEST_P(Light, OfBandsFarApartIsThatOfEachAlone) {
    const std::vector<double> emissions = {0, 1e-30, 1, 1e30, 1e-200, 1e200};
    const Mesh mesh = uncut(cube({0.5, 0.25, 0.5, 0.75, 0.125, 0.0}, emissions));
    EXPECT_EQ(plan_bands(mesh).solved.size(), emissions.size());

    const Solution solution = solution_of(mesh, settings(64, GetParam(), 1e-5));

    expect_numbers(solution);
    EXPECT_EQ(mean_irradiance(mesh, solution, 0), 0);
    for (std::size_t band = 1; band < emissions.size(); ++band) {
        const double rho = mesh.materials[0].reflectance[band];
        const double expected = kPi * emissions[band] / (1 - rho);
        EXPECT_NEAR(mean_irradiance(mesh, solution, band) / expected, 1, 1e-5 + 1e-6) << band;
    }
}

// The weak one sees nothing; its flux is less than a float's share of what the strong one emits.
TEST_P(Light, OfAWeakLampBesideAStrongOneIsItsOwnRadiosity) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1), rectangle(2, 0, 3, 1)});
    scene.materials = {{"weak", {0.5}, {1e-30}, false}, {"strong", {0.5}, {1e30}, false}};
    scene.faces[1].material = 1;
    const Mesh mesh = uncut(scene);

    const Solution solution = solution_of(mesh, settings(64, GetParam(), 1e-3));

    expect_numbers(solution);
    EXPECT_EQ(solution.radiosity[0][0], kPi * 1e-30);
    EXPECT_EQ(solution.radiosity[0][1], kPi * 1e30);
    EXPECT_NEAR(solution.ledger[0].escaped / solution.ledger[0].emitted, 1, 0x1p-23);
}

TEST_P(Light, ThatSeesNothingEscapes) {
    Scene scene = scene_of({rectangle(0, 0, 1, 1)});
    add_face(scene, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, 1);  // looks up, away
    scene.materials.push_back({"lamp", {0.5}, {1}, false});
    const Mesh mesh = uncut(scene);

    const Solution solution = solution_of(mesh, settings(64, GetParam(), 1e-3));

    expect_numbers(solution);
    EXPECT_EQ(solution.shots, 1u);
    EXPECT_EQ(solution.irradiance[0], std::vector<double>(2, 0.0));
    EXPECT_EQ(solution.ledger[0].absorbed, 0);
}

TEST_P(Light, OfASubnormalReflectanceIsThatOfBlack) {
    const Mesh dim = uncut(cube({1e-320}, {1})), black = uncut(cube({0}, {1}));
    const auto how = settings(64, GetParam(), 1e-3);

    EXPECT_EQ(solution_of(dim, how).irradiance, solution_of(black, how).irradiance);
}

std::string refusal(double emission) {
    const Mesh mesh = uncut(cube({0.5}, {emission}));
    const auto device = mp1map::Device::open("");
    try {
        ProgressiveSolver(mesh, settings(64), device);
    } catch (const InputError& fault) {
        return fault.what();
    }
    return {};
}

TEST(CountableLight, EndsWhereFluxesOrRadiositiesDo) {
    EXPECT_EQ(refusal(0), "");
    EXPECT_EQ(refusal(1e-268), "");
    EXPECT_EQ(refusal(1e299), "");
    EXPECT_EQ(refusal(1e308),
              "band \"band0\" emits inf W/m^2; light from 1.9e-270 W to 1.1e+301 W is counted");
    EXPECT_NE(refusal(1e302), "");
    EXPECT_NE(refusal(5e300), "");  // of a wall; six of them are too much
    EXPECT_NE(refusal(1e-310), "");
    EXPECT_NE(refusal(1e-271), "");
}

// At the ends of what is counted the ledger still closes.
TEST(CountableLight, IsCountedToItsEnds) {
    for (const double emission : {1.2e-271, 5e299}) {
        const Mesh mesh = uncut(cube({0.5}, {emission}));

        const Solution solution = solution_of(mesh, settings(64, 1e-5));

        expect_numbers(solution);
        EXPECT_LT(largest_residual(solution), 1e-6) << emission;
        EXPECT_NEAR(mean_irradiance(mesh, solution, 0) / (2 * kPi * emission), 1, 2e-5);
    }
}

}  // namespace
}  // namespace hemirad::test::solves_light_test
