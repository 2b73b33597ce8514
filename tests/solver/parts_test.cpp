#include <gtest/gtest.h>

#include "errors.h"
#include "solver/ambient.h"
#include "solver/support.h"

// Lights apart, and direct light: further bands of one solve.
namespace hemirad::test::parts_test {
namespace {

using Kind = SolutionPart::Kind;

constexpr double kTolerance = 1e-3;

/// The crate glows, too: in a colour of its own, and far weaker than the lamp.
Mesh room_of_two_lights() {
    Scene scene = furnished_room();
    scene.materials.push_back({"glow", {0.5, 0.3, 0.1}, {0.01, 0.02, 0.002}, false});
    for (auto& face : scene.faces)
        if (face.object == 2) face.material = 4;
    return meshed(scene, 1);
}

SolverSettings with(PartSettings parts) {
    SolverSettings result = settings(64, kTolerance);
    result.parts = parts;
    return result;
}

Mesh darkened(Mesh mesh, std::size_t material) {
    for (double& radiance : mesh.materials[material].emission) radiance = 0;
    return mesh;
}

// Of all light that a band absorbs, the share that two solutions differ by.
double difference_in_flux(const Mesh& mesh, const std::vector<double>& a,
                          const std::vector<double>& b) {
    double flux = 0, off = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        flux += mesh.area(mesh.patches[i]) * b[i];
        off += mesh.area(mesh.patches[i]) * std::abs(a[i] - b[i]);
    }
    return off / flux;
}

TEST(LightsApart, AreWhatEachGivesAlone) {
    const Mesh mesh = room_of_two_lights();
    const Solution solution = solution_of(mesh, with({.lights = Lights::separate}));
    ASSERT_EQ(solution.parts.size(), 2u);
    EXPECT_EQ(solution.parts[0].name, "lamp");
    EXPECT_EQ(solution.parts[1].name, "crate");

    const Solution lamp = solution_of(darkened(mesh, 4), settings(64, kTolerance));
    const Solution crate = solution_of(darkened(mesh, 1), settings(64, kTolerance));

    // Reflections multiply what is unshot by 1 / (1 - rho) at most.
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_LT(
            difference_in_flux(mesh, solution.parts[0].irradiance[band], lamp.irradiance[band]),
            5 * kTolerance);
        EXPECT_LT(
            difference_in_flux(mesh, solution.parts[1].irradiance[band], crate.irradiance[band]),
            5 * kTolerance);
    }
}

TEST(LightsApart, AddUpToTheWhole) {
    const Mesh mesh = room_of_two_lights();
    const Solution solution = solution_of(mesh, with({.lights = Lights::separate}));
    const Solution together = solution_of(mesh, with({}));

    for (std::size_t band = 0; band < 3; ++band) {
        const auto &lamp = solution.parts[0], &crate = solution.parts[1];
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            EXPECT_DOUBLE_EQ(lamp.irradiance[band][i] + crate.irradiance[band][i],
                             solution.irradiance[band][i]);
            EXPECT_DOUBLE_EQ(lamp.radiosity[band][i] + crate.radiosity[band][i],
                             solution.radiosity[band][i]);
        }
        EXPECT_LT(difference_in_flux(mesh, solution.irradiance[band], together.irradiance[band]),
                  5 * kTolerance);
    }
}

TEST(LightsApart, KeepBooksAndToleranceEach) {
    const Solution solution = solution_of(room_of_two_lights(), with({.lights = Lights::separate}));

    EXPECT_TRUE(solution.converged);
    for (const auto& part : solution.parts)
        for (const Ledger& ledger : part.ledger) {
            EXPECT_GT(ledger.emitted, 0);
            EXPECT_LT(ledger.unshot, kTolerance * ledger.emitted);
            EXPECT_LT(ledger.residual(), 1e-5);
        }
    for (std::size_t band = 0; band < 3; ++band) {
        EXPECT_LT(solution.ledger[band].residual(), 1e-5);
        EXPECT_DOUBLE_EQ(
            solution.ledger[band].absorbed,
            solution.parts[0].ledger[band].absorbed + solution.parts[1].ledger[band].absorbed);
    }
}

double sum_of_parts(const Solution& solution, std::size_t patch) {
    double sum = 0;
    for (const auto& part : solution.parts) sum += part.irradiance[1][patch];
    return sum;
}

TEST(Parts, AddUpWhileWhatIsUnshotIsSpread) {
    const Mesh mesh = room_of_two_lights();
    for (const PartSettings& parts : {PartSettings{.lights = Lights::separate},
                                      PartSettings{.direct = true, .indirect = true}}) {
        auto how = with(parts);
        how.max_shots = 5;

        const Solution solution = with_ambient(mesh, solution_of(mesh, how));

        ASSERT_EQ(solution.parts.size(), 2u);
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            ASSERT_GT(solution.irradiance[1][i], 0);
            EXPECT_NEAR(sum_of_parts(solution, i) / solution.irradiance[1][i], 1, 1e-6);
        }
    }
}

TEST(DirectLight, ChangesNoBitOfTheWhole) {
    const Mesh mesh = room_of_two_lights();

    const Solution apart = solution_of(mesh, with({.direct = true, .indirect = true}));
    const Solution plain = solution_of(mesh, with({}));

    EXPECT_EQ(apart.shots, plain.shots);
    EXPECT_EQ(apart.irradiance, plain.irradiance);
    EXPECT_EQ(apart.radiosity, plain.radiosity);
}

TEST(DirectLight, IsWhatABlackRoomReceives) {
    const Mesh mesh = room_of_two_lights();
    Mesh black = mesh;
    for (auto& material : black.materials) material.reflectance.assign(3, 0.0);

    const Solution solution = solution_of(mesh, with({.direct = true}));
    const Solution direct = solution_of(black, settings(64, 1e-9));

    ASSERT_EQ(solution.parts.size(), 1u);
    ASSERT_EQ(solution.parts[0].kind, Kind::direct);
    for (std::size_t band = 0; band < 3; ++band)
        EXPECT_LT(
            difference_in_flux(mesh, solution.parts[0].irradiance[band], direct.irradiance[band]),
            kTolerance);
}

TEST(DirectLight, AndTheRestAreTheWhole) {
    const Mesh mesh = room_of_two_lights();

    const Solution solution = solution_of(mesh, with({.direct = true, .indirect = true}));

    ASSERT_EQ(solution.parts.size(), 2u);
    std::size_t lit = 0, dark = 0;  // the crate's underside is
    for (std::size_t band = 0; band < 3; ++band)
        for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
            double irradiance = 0, radiosity = 0;
            for (const auto& part : solution.parts) {
                EXPECT_GE(part.irradiance[band][i], 0);
                irradiance += part.irradiance[band][i];
                radiosity += part.radiosity[band][i];
            }
            const double whole = solution.irradiance[band][i];
            EXPECT_NEAR(irradiance, whole, 1e-6 * whole);
            EXPECT_NEAR(radiosity, solution.radiosity[band][i], 1e-6 * solution.radiosity[band][i]);
            (whole > 0 ? lit : dark) += 1;
        }
    EXPECT_GT(lit, 9 * dark);
}

std::size_t bands_of(const Mesh& mesh, PartSettings parts) {
    return plan_bands(mesh, parts).solved.size();
}

TEST(Parts, ShareBandsOfOneSpectrum) {
    Mesh mesh = room_of_two_lights();
    EXPECT_EQ(bands_of(mesh, {}), 3u);
    EXPECT_EQ(bands_of(mesh, {.lights = Lights::separate}), 6u);
    EXPECT_EQ(bands_of(mesh, {.direct = true}), 6u);
    EXPECT_EQ(bands_of(darkened(mesh, 4), {.direct = true}), 4u);  // one lamp, one spectrum

    for (auto& material : mesh.materials) material.reflectance.assign(3, 0.3);

    EXPECT_EQ(bands_of(mesh, {}), 3u);  // neither lamp is grey, nor are they of one colour
    EXPECT_EQ(bands_of(mesh, {.lights = Lights::separate}), 2u);
}

TEST(Parts, ThatADeviceCannotHoldAreRefused) {
    mp1map::DeviceSummary small;
    small.local_memory = 32768;  // the least that OpenCL 1.2 allows
    mp1map::PeArray array;
    array.width = array.height = 8;
    EXPECT_EQ(most_bands(small, array), 68u);
    array.width = array.height = 64;
    EXPECT_EQ(most_bands(small, array), 64u);

    Mesh mesh = mesh_of(box({1, 1, 1}, 1));
    mesh.bands.assign(2000, "band");
    mesh.materials = {{"wall", {}, std::vector<double>(2000, 1.0), false}};
    for (std::size_t band = 0; band < 2000; ++band)
        mesh.materials[0].reflectance.push_back(double(band) / 2001);
    EXPECT_THROW(ProgressiveSolver(mesh, settings(64), mp1map::Device::open("")), InputError);
}

}  // namespace
}  // namespace hemirad::test::parts_test
