#include <gtest/gtest.h>

#include "solver/lightmap_bytes.h"
#include "solver/nothing_escapes.h"
#include "solver/support.h"

// What the other tests show on small settings, on the scenes as a user solves them.
namespace hemirad::test::long_test {
namespace {

std::vector<Machine> all_machines() {
    std::vector<Machine> machines = {
        {"default", {}}, {"again", {}}, {"1 compute unit", {}, 1}, {"2 compute units", {}, 2}};
    for (const std::uint32_t lanes : {1u, 4u, 8u, 16u})
        machines.push_back({"lanes " + std::to_string(lanes), {0, 0, lanes, 0, 0}});
    for (const std::uint32_t edge : {8u, 16u, 32u, 64u})
        machines.push_back(
            {std::to_string(edge) + " x " + std::to_string(edge) + " PEs", {edge, edge, 1, 0, 0}});
    return machines;
}

TEST(LongSameBits, OfTheCornellBox) {
    expect_same_bytes(meshed(scene_named("cornell.gltf"), 0), settings(512, 1e-3, 300),
                      all_machines());
}

TEST(LongSameBits, OfTheSmallHall) {
    expect_same_bytes(meshed(scene_named("hall2k.obj"), 0), settings(512, 1e-3, 150),
                      all_machines());
}

class LongLedgers : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, LongLedgers,
                         testing::Values("furnace.obj", "squares.obj", "cornell.gltf", "lroom.obj",
                                         "hall2k.obj", "hall14k.obj"));

// Shots enough for all but the halls to converge, and few enough for the halls to end.
TEST_P(LongLedgers, AddUpAfterTenThousandShots) {
    const Mesh mesh = meshed(scene_named(GetParam()), 0);
    const auto device = mp1map::Device::open("");
    ProgressiveSolver solver(mesh, settings(512, 1e-3, 10'000), device);

    solver.solve(go_on);

    const Solution solution = solver.solution();
    EXPECT_EQ(solver.closure().least, 1.0);
    EXPECT_EQ(solver.closure().most, 1.0);
    for (const auto& ledger : solution.ledger) {
        EXPECT_LT(ledger.residual(), 1e-5);
        EXPECT_EQ(ledger.escaped == 0, mesh.closed);
    }
    RecordProperty("shots", std::to_string(solution.shots));
    RecordProperty("residual", std::to_string(solution.ledger[0].residual()));
}

TEST(LongClosure, NothingEscapesFromTheHallsInAnyPosition) {
    std::mt19937 random(7);
    for (const std::uint32_t resolution : {64u, 256u, 1024u})
        for (const auto* name : {"hall2k.obj", "hall14k.obj"}) {
            const Scene hall = scene_named(name);
            const std::uint32_t step = resolution == 1024 ? 11 : 1;
            expect_nothing_escapes(meshed(hall, 0), resolution, step);
            expect_nothing_escapes(meshed(rotated(hall, random_rotation(random)), 0.41), resolution,
                                   step);
        }
}

}  // namespace
}  // namespace hemirad::test::long_test
