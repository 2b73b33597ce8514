#include <gtest/gtest.h>

#include "errors.h"
#include "solver/solved.h"
#include "solver/support.h"

// A solve that goes on from a state of another ends as if it had never stopped.
namespace hemirad::test::resume_test {
namespace {

Solved ended(ProgressiveSolver& solver) {
    solver.solve(go_on);
    return {solver.solution(), solver.closure(), solver.repeated_shots()};
}

Solved solved(const Mesh& mesh, const SolverSettings& how) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    return ended(solver);
}

Solved resumed(const Mesh& mesh, const SolverSettings& how, const SolveState& state) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    solver.resume(state);
    return ended(solver);
}

/// After the first looks, between which a shooter of several hemispheres is still at them, and then
/// at every `spacing`-th.
std::vector<SolveState> states_on_the_way(const Mesh& mesh, SolverSettings how,
                                          std::uint64_t spacing) {
    constexpr std::uint64_t kFirst = 3;
    how.stop_every = {1};
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, how, device);
    std::vector<SolveState> states;
    std::uint64_t looks = 0;
    solver.solve([&](const Progress&) {
        if (++looks <= kFirst || looks % spacing == 0) states.push_back(solver.state());
        return true;
    });
    states.push_back(solver.state());
    return states;
}

void expect_same_end_from_everywhere(const Mesh& mesh, SolverSettings how, std::uint64_t spacing) {
    how.count_shots = true;
    const Solved whole = solved(mesh, how);
    const auto states = states_on_the_way(mesh, how, spacing);
    ASSERT_GT(states.size(), 4u);
    for (const auto& state : states) {
        SCOPED_TRACE(state.shots);
        expect_equal(resumed(mesh, how, state), whole);
    }
}

Mesh box() { return meshed(scene_named("cornell.gltf"), 0.2); }

struct Way {
    FormFactorMode mode;
    std::uint32_t salvo;
    std::optional<std::uint64_t> row_bytes;
    std::string name;
};

class Resume : public testing::TestWithParam<Way> {
  protected:
    SolverSettings how() const {
        auto result = settings(64);
        result.form_factor = GetParam().mode;
        result.shooter_samples = 2;
        result.salvo = GetParam().salvo;
        result.row_bytes = GetParam().row_bytes;
        return result;
    }
};

INSTANTIATE_TEST_SUITE_P(Ways, Resume,
                         testing::Values(Way{FormFactorMode::analytic, 1, {}, "analytic"},
                                         Way{FormFactorMode::analytic, 8, {}, "salvos"},
                                         Way{FormFactorMode::count, 8, 0,
                                             "countSalvosWithoutRows"}),
                         [](const auto& way) { return way.param.name; });

TEST_P(Resume, EndsWithTheBitsOfAWholeSolve) { expect_same_end_from_everywhere(box(), how(), 60); }

TEST_P(Resume, GoesOnAfterALimitOfShots) {
    const Mesh mesh = box();
    const Solved whole = solved(mesh, how());
    int cut_short = 0;
    for (const std::uint64_t most : {1u, 100u, 101u, 102u, 103u}) {
        SCOPED_TRACE(most);
        auto limited = how();
        limited.max_shots = most;
        const auto device = mp1map::Device::open("");
        ProgressiveSolver solver(mesh, limited, device);
        EXPECT_EQ(solver.solve(go_on), Stop::max_shots);
        EXPECT_EQ(solver.solution().shots, most);
        const auto state = solver.state();
        EXPECT_GT(state.shots + how().salvo, most);

        cut_short += state.shots < most;

        expect_equal(resumed(mesh, how(), state), whole);
        expect_equal(resumed(mesh, limited, state),
                     {solver.solution(), solver.closure(), solver.repeated_shots()});
    }
    EXPECT_EQ(cut_short > 0, how().salvo > 1);
}

TEST(Resumed, GoesOnToATighterTolerance) {
    const Mesh mesh = box();
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, settings(64, 1e-2), device);
    EXPECT_EQ(solver.solve(go_on), Stop::converged);

    expect_equal(resumed(mesh, settings(64), solver.state()), solved(mesh, settings(64)));
}

TEST(Resumed, WithTwoLevelsEndsWithTheSameBits) {
    const Mesh mesh =
        build_mesh(scene_named("cornell.gltf"),
                   {.patch_size = 0.2, .element_size = 0.07, .max_reflectance = 0.995});
    auto how = settings(64, 1e-2);
    how.form_factor = FormFactorMode::analytic;

    expect_same_end_from_everywhere(mesh, how, 20);
}

TEST(Resumed, WithLightsApartEndsWithTheSameBits) {
    Scene scene = furnished_room();
    scene.materials.push_back({"glow", {0.5, 0.3, 0.1}, {0.01, 0.02, 0.002}, false});
    for (auto& face : scene.faces)
        if (face.object == 2) face.material = 4;
    const Mesh mesh = meshed(scene, 1);
    auto how = settings(64);
    how.parts.lights = Lights::separate;

    expect_same_end_from_everywhere(mesh, how, 100);
}

TEST(Resumed, OnAnotherArrayEndsWithTheSameBits) {
    const Mesh mesh = box();
    auto how = settings(64);
    how.pe_array = {1, 1, 4, 4, 4};
    const auto states = states_on_the_way(mesh, how, 100);
    how.pe_array = {4, 1, 16, 64, 64};
    const Solved whole = solved(mesh, how);

    expect_equal(resumed(mesh, how, states[3]), whole);
}

TEST(Resumed, CarriesTheBooks) {
    const Mesh mesh = box();
    const auto how = settings(64);
    const auto device = mp1map::Device::open("");
    ProgressiveSolver first(mesh, how, device);
    first.solve([](const Progress& progress) { return progress.shots < 300; });
    ASSERT_GT(first.repeated_shots(), 0u);
    ProgressiveSolver second(mesh, how, device);

    second.resume(first.state());

    EXPECT_EQ(second.repeated_shots(), first.repeated_shots());
    EXPECT_EQ(second.solution().shots, first.solution().shots);
    EXPECT_EQ(second.solution().irradiance, first.solution().irradiance);
}

TEST(Resumed, RefusesTheStateOfAnotherMesh) {
    const auto device = mp1map::Device::open("");
    const Mesh coarse = meshed(scene_named("furnace.obj"), 0.5), fine = box();
    ProgressiveSolver other(coarse, settings(64), device), solver(fine, settings(64), device);

    EXPECT_THROW(solver.resume(other.state()), InputError);
}

TEST(Resume, RefusesWhatNoSolveComesTo) {
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(box(), settings(64), device);
    const SolveState state = solver.state();
    SolveState dark = state, long_ago = state;
    dark.received.front() = std::numeric_limits<float>::quiet_NaN();
    long_ago.shots = std::uint64_t{1} << 32;

    EXPECT_THROW(solver.resume(dark), InputError);
    EXPECT_THROW(solver.resume(long_ago), InputError);
}

}  // namespace
}  // namespace hemirad::test::resume_test
