#include <gtest/gtest.h>

#include <iostream>

#include "extremes/closed_scenes.h"
#include "solver/nothing_escapes.h"

// No proxel escapes from a closed scene, whatever its shape, its cuts and its turn.
namespace hemirad::test::closed_test {
namespace {

Pieces turned(Pieces pieces, const glm::dmat3& rotation) {
    for (auto& polygon : pieces.polygons)
        for (auto& corner : polygon.corners) corner = rotation * corner;
    return pieces;
}

void expect_none(const Escapes& escapes, const std::string& scene, std::uint32_t resolution) {
    EXPECT_EQ(escapes.escaped, 0u)
        << scene << ", resolution " << resolution << ": of " << escapes.proxels << " proxels; "
        << escapes.worst << " from shooter " << escapes.worst_shooter << ", part "
        << escapes.worst_part;
    EXPECT_GT(escapes.proxels, 0u);
}

void print(const std::string& scene, std::uint32_t resolution, const Escapes& escapes) {
    std::cout << "limit: closed | " << scene << " | " << resolution << "^2 | " << escapes.shots
              << " shots | " << escapes.proxels << " proxels | " << escapes.escaped << " escaped\n";
}

constexpr std::array kCuts = {Cut::whole, Cut::fan, Cut::quarters, Cut::t_junctions};
const char* name_of(Cut cut) {
    constexpr std::array kNames = {"Whole", "Fans", "Quarters", "TJunctions"};
    return kNames[static_cast<std::size_t>(cut)];
}

// Flat, long or round.
glm::dvec3 random_half(std::mt19937_64& random) {
    std::uniform_real_distribution<double> exponent(-1.3, 0);
    return {1, std::pow(10, exponent(random)), std::pow(10, exponent(random))};
}

void expect_polyhedra_closed(Cut cut, std::uint32_t resolution, int rooms, int most_points,
                             unsigned seed, std::uint32_t step = 1) {
    std::mt19937_64 random(seed);
    std::mt19937 turns(seed);
    Escapes all;
    for (int room = 0; room < rooms; ++room) {
        const int points = 4 + static_cast<int>(random() % static_cast<unsigned>(most_points - 3));
        const auto half = random_half(random);
        const auto pieces = turned(random_room(points, half, cut, random), random_rotation(turns));
        const auto escapes = escapes_from(mesh_of(pieces), resolution, step);
        expect_none(escapes,
                    std::string(name_of(cut)) + ", room " + std::to_string(room) + " of seed " +
                        std::to_string(seed),
                    resolution);
        all += escapes;
    }
    print(std::string("polyhedra, ") + name_of(cut), resolution, all);
}

// A room of 1 with an object of 1e-5 somewhere in it, seen from the walls and from the object.
void expect_closed_around_tiny_objects(std::uint32_t resolution, int rooms, double size,
                                       unsigned seed, std::uint32_t step = 1) {
    std::mt19937_64 random(seed);
    Escapes all;
    for (int room = 0; room < rooms; ++room) {
        const glm::dvec3 half(1, 0.8, 0.6);
        auto pieces = random_room(24, half, kCuts[std::size_t(room) % kCuts.size()], random);
        const auto at = 0.3 * half * random_direction(random);
        add_object(pieces, 8, size, at, random);
        const auto escapes = escapes_from(mesh_of(pieces), resolution, step);
        expect_none(escapes, "object of " + std::to_string(size), resolution);
        all += escapes;
    }
    std::ostringstream scene;
    scene << "polyhedra, an object of " << size << " inside";
    print(scene.str(), resolution, all);
}

void expect_furnished_rooms_closed(std::uint32_t resolution, int rooms, unsigned seed,
                                   std::uint32_t step) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> size(0.3, 1.5);
    for (int room = 0; room < rooms; ++room) {
        const Scene scene = rotated(furnished_room(), random_rotation(random));
        expect_nothing_escapes(meshed(scene, size(random)), resolution, step);
    }
}

class Closed : public testing::TestWithParam<Cut> {};
INSTANTIATE_TEST_SUITE_P(Cuts, Closed, testing::ValuesIn(kCuts),
                         [](const auto& cut) { return name_of(cut.param); });

TEST_P(Closed, NothingEscapesFromRandomPolyhedra) {
    expect_polyhedra_closed(GetParam(), 64, 12, 40, 1);
    expect_polyhedra_closed(GetParam(), 256, 5, 40, 2);
}

TEST(ClosedRooms, NothingEscapesPastATinyObject) {
    for (const double size : {1e-3, 1e-5, 1e-7}) expect_closed_around_tiny_objects(64, 4, size, 3);
    expect_closed_around_tiny_objects(256, 2, 1e-5, 4);
}

TEST(ClosedRooms, NothingEscapesFromFurnishedRoomsTurnedAtRandom) {
    expect_furnished_rooms_closed(64, 6, 5, 1);
    expect_furnished_rooms_closed(256, 3, 6, 3);
}

// A plane is seen from higher than kPlaneMargin of the distance of a corner; from below, it
// touches, and half of the hemisphere or all of it is lost. Walls of 4 x 4 patches of 3 x 3
// shooters: the lowest are a 24th of the height above the floor, and the nearest corner is within
// 0.36.
TEST(ClosedRooms, NothingEscapesFromFlatRoomsDownToACrack) {
    std::mt19937 random(7);
    for (const double height : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9}) {
        Pieces pieces;
        const auto walls = box({1, 1, 0.5 * height}, 4);
        for (std::size_t patch = 0; patch < walls.size(); ++patch)
            pieces.add(walls[patch], std::uint32_t(patch / 16));
        const auto escapes = escapes_from(mesh_of(turned(pieces, random_rotation(random))), 64, 5);
        std::ostringstream scene;
        scene << "box of height " << height << " and width 2";
        print(scene.str(), 64, escapes);
        if (height > 24 * (0.36 * kPlaneMargin + 2 * kGridMargin))
            expect_none(escapes, scene.str(), 64);
    }
}

class LongClosed : public testing::TestWithParam<Cut> {};
INSTANTIATE_TEST_SUITE_P(Cuts, LongClosed, testing::ValuesIn(kCuts),
                         [](const auto& cut) { return name_of(cut.param); });

TEST_P(LongClosed, NothingEscapesFromRandomPolyhedra) {
    expect_polyhedra_closed(GetParam(), 64, 300, 60, 11);
    expect_polyhedra_closed(GetParam(), 256, 100, 60, 12);
    expect_polyhedra_closed(GetParam(), 1024, 10, 60, 13);
    expect_polyhedra_closed(GetParam(), 2048, 4, 60, 14);
}

TEST(LongClosedRooms, NothingEscapesPastATinyObject) {
    for (const double size : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) {
        expect_closed_around_tiny_objects(256, 8, size, 15);
        expect_closed_around_tiny_objects(1024, 4, size, 16, 3);
    }
}

TEST(LongClosedRooms, NothingEscapesFromFurnishedRoomsTurnedAtRandom) {
    expect_furnished_rooms_closed(1024, 6, 17, 3);
    expect_furnished_rooms_closed(2048, 3, 18, 7);
}

}  // namespace
}  // namespace hemirad::test::closed_test
