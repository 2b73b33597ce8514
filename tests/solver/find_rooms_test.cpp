#include "solver/find_rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "scene/scenes_by_hand.h"
#include "solver/support.h"

// What cannot see each other because closed walls are in between.
namespace hemirad::test::find_rooms_test {
namespace {

using Faces = std::vector<std::vector<glm::dvec3>>;

const glm::dvec3 kLow(1.13, 1.27, 0), kHigh(2.81, 2.63, 1);

Faces without_floor(const Faces& faces) {
    Faces result;
    for (const auto& face : faces)
        if (face[0].z + face[1].z + face[2].z > 0) result.push_back(face);
    return result;
}

Faces joined(std::initializer_list<Faces> parts) {
    Faces all;
    for (const Faces& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

Faces hall() { return room({0, 0, 0}, {4, 4, 2}); }

/// On the hall's floor, which is its own.
Faces chamber(double thickness) {
    const glm::dvec3 wall(thickness, thickness, 0), roof(0, 0, thickness);
    return joined({without_floor(solid_box(kLow - wall, kHigh + wall + roof)),
                   without_floor(room(kLow, kHigh))});
}

bool is_within(const glm::dvec3& at) {
    return glm::all(glm::greaterThan(at, kLow)) && glm::all(glm::lessThan(at, kHigh));
}

/// Which of two kinds of patches see which.
struct Sight {
    int pairs[2][2] = {};  ///< [within, from][within, to] pairs of patches that may see each other
    int patches[2] = {};

    bool all(int from, int to) const {
        return patches[from] > 0 && pairs[from][to] == patches[from] * patches[to];
    }
    bool none(int from, int to) const { return patches[from] > 0 && pairs[from][to] == 0; }
};

Sight sight(const Mesh& mesh, const std::function<bool(const glm::dvec3&)>& is_within) {
    const Rooms rooms = find_rooms(mesh);
    std::vector<int> within;
    Sight sight;
    for (const Patch& patch : mesh.patches) {
        within.push_back(is_within(mesh.centroid(patch) + 1e-4 * mesh.normal(patch)) ? 1 : 0);
        ++sight.patches[within.back()];
    }
    for (std::size_t from = 0; from < within.size(); ++from)
        for (std::size_t to = 0; to < within.size(); ++to)
            if (rooms.before.empty() || (rooms.reached[from] & rooms.before[to]) != 0)
                ++sight.pairs[within[from]][within[to]];
    return sight;
}

Sight sight(const Faces& faces, Backfaces backfaces = Backfaces::automatic) {
    return sight(meshed(scene_of(faces), 0.4, backfaces), is_within);
}

class RoomOfWalls : public testing::TestWithParam<double> {};

INSTANTIATE_TEST_SUITE_P(Thickness, RoomOfWalls, testing::Values(0, 1e-3, 0.1));

TEST_P(RoomOfWalls, SeesAndIsSeenFromWithinOnly) {
    for (const auto backfaces : {Backfaces::automatic, Backfaces::block, Backfaces::cull}) {
        const Sight found = sight(joined({hall(), chamber(GetParam())}), backfaces);

        EXPECT_TRUE(found.all(1, 1));
        EXPECT_TRUE(found.none(0, 1) || GetParam() > 0);
        EXPECT_TRUE(found.none(1, 0));
    }
}

// Its patches meet where none has a corner, to what the file's decimals leave.
TEST_P(RoomOfWalls, MayStandAtAnyAngle) {
    const Faces straight = joined({hall(), chamber(GetParam())});
    for (const double angle : {0.1, 0.5, 1.2}) {
        const auto turn = [&](const glm::dvec3& p) {
            const glm::dvec3 once(std::cos(angle) * p.x - std::sin(angle) * p.y,
                                  std::sin(angle) * p.x + std::cos(angle) * p.y, p.z);
            return glm::dvec3(once.x, std::cos(2 * angle) * once.y - std::sin(2 * angle) * once.z,
                              std::sin(2 * angle) * once.y + std::cos(2 * angle) * once.z);
        };
        const auto turn_back = [&](const glm::dvec3& p) {
            const glm::dvec3 once(p.x, std::cos(2 * angle) * p.y + std::sin(2 * angle) * p.z,
                                  -std::sin(2 * angle) * p.y + std::cos(2 * angle) * p.z);
            return glm::dvec3(std::cos(angle) * once.x + std::sin(angle) * once.y,
                              -std::sin(angle) * once.x + std::cos(angle) * once.y, once.z);
        };
        Faces turned = straight;
        for (auto& face : turned)
            for (auto& corner : face) corner = glm::dvec3(glm::vec3(turn(corner)));

        const Sight found = sight(meshed(scene_of(turned), 0.4),
                                  [&](const glm::dvec3& at) { return is_within(turn_back(at)); });

        EXPECT_TRUE(found.all(1, 1)) << angle;
        EXPECT_TRUE(found.none(1, 0)) << angle;
    }
}

TEST(FindRooms, ADoorMakesRoomAndHallOne) {
    Faces faces = joined({hall(), chamber(0)});
    // The walls at y = 1.27 get an opening.
    std::erase_if(faces, [](const auto& face) {
        return std::ranges::all_of(face, [](const glm::dvec3& p) { return p.y == 1.27; });
    });
    const Faces wall = {{{1.13, 1.27, 0}, {1.5, 1.27, 0}, {1.5, 1.27, 1}, {1.13, 1.27, 1}},
                        {{1.5, 1.27, 0.8}, {2, 1.27, 0.8}, {2, 1.27, 1}, {1.5, 1.27, 1}},
                        {{2, 1.27, 0}, {2.81, 1.27, 0}, {2.81, 1.27, 1}, {2, 1.27, 1}}};
    for (const auto& face : wall) {
        faces.push_back(face);
        faces.push_back(reversed(face));
    }

    const Sight found = sight(faces);

    EXPECT_TRUE(found.all(0, 1) && found.all(1, 0));
}

TEST(FindRooms, WhatFloatsInARoomIsPartOfIt) {
    const Faces in_hall = solid_box({0.3, 0.3, 1.2}, {0.6, 0.6, 1.5});
    const Faces in_chamber = solid_box({1.5, 1.5, 0.3}, {1.8, 1.8, 0.6});

    const Sight found = sight(joined({hall(), chamber(0), in_hall, in_chamber}));

    EXPECT_TRUE(found.all(1, 1) && found.all(0, 0));
    EXPECT_TRUE(found.none(1, 0) && found.none(0, 1));
}

TEST(FindRooms, ABoxInABoxMayFloat) {
    const glm::dvec3 up(0, 0, 0.5), wall(0.1);
    const Faces faces = joined(
        {hall(), solid_box(kLow + up - wall, kHigh + up + wall), room(kLow + up, kHigh + up)});

    const Sight found = sight(meshed(scene_of(faces), 0.4),
                              [&](const glm::dvec3& at) { return is_within(at - up); });

    EXPECT_TRUE(found.all(1, 1) && found.all(0, 0));
    EXPECT_TRUE(found.none(1, 0) && found.none(0, 1));
}

TEST(FindRooms, WhatSticksThroughAWallIsSeenOnBothSides) {
    const glm::dvec3 low(0.5, 1.6, 0.3), high(2, 1.9, 0.6);

    const Mesh mesh = meshed(scene_of(joined({hall(), chamber(0), solid_box(low, high)})), 0.4);
    const Rooms rooms = find_rooms(mesh);

    if (rooms.before.empty()) return;
    std::uint32_t beam = 0, inside = 0, outside = 0;
    for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
        const glm::dvec3 at = mesh.centroid(mesh.patches[i]);
        const bool is_beam =
            glm::all(glm::greaterThanEqual(at, low)) && glm::all(glm::lessThanEqual(at, high));
        if (is_beam)
            beam |= rooms.before[i];
        else
            (is_within(at + 1e-3 * mesh.normal(mesh.patches[i])) ? inside : outside) |=
                rooms.before[i];
    }
    EXPECT_EQ(inside & beam, beam);
    EXPECT_EQ(outside & beam, beam);
}

TEST(FindRooms, AGapUnderAWallLetsLightIn) {
    Faces faces = chamber(0);
    for (auto& face : faces)
        for (auto& corner : face)
            if (corner.z == 0) corner.z = 1e-3;

    const Sight found = sight(joined({hall(), faces}));

    EXPECT_TRUE(found.all(0, 1) && found.all(1, 0));
}

// A stage is seen through the backs of its walls, and sees nothing of who looks.
TEST(FindRooms, LightPassesBacksOneWay) {
    const Faces lamp = solid_box({1.5, 1.5, 3}, {2, 2, 3.5});

    const Sight found = sight(meshed(scene_of(joined({hall(), lamp})), 0.4, Backfaces::cull),
                              [](const glm::dvec3& at) { return at.z < 2; });

    EXPECT_TRUE(found.all(0, 1) && found.all(1, 1));
    EXPECT_TRUE(found.none(1, 0));
}

TEST(FindRooms, OneRoomIsNotWorthAWord) {
    EXPECT_TRUE(find_rooms(meshed(scene_of(hall()), 0.4)).before.empty());
    EXPECT_TRUE(find_rooms(mesh_of(box({1, 1, 1}, 2))).before.empty());
}

TEST(FindRooms, SmallRoomsBeyondThirtyOneShareABit) {
    Faces faces = hall();
    for (int i = 0; i < 40; ++i) {
        const glm::dvec3 low(0.2 + 0.4 * (i % 8), 0.2 + 0.6 * (i / 8), 0.5);
        const glm::dvec3 high = low + glm::dvec3(0.1 + 0.001 * i);
        faces = joined({faces, solid_box(low, high), room(low, high)});
    }
    const Mesh mesh = meshed(scene_of(faces), 10);

    const Rooms rooms = find_rooms(mesh);

    ASSERT_EQ(rooms.before.size(), mesh.patches.size());
    std::map<std::uint32_t, int> patches;
    for (const std::uint32_t room : rooms.before) ++patches[room];
    EXPECT_EQ(patches.size(), 32u);
    EXPECT_EQ(patches[1], 6 + 40 * 6);
    EXPECT_EQ(patches[1u << 31], 10 * 6);
}

}  // namespace
}  // namespace hemirad::test::find_rooms_test
