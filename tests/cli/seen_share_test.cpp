#include "cli/seen_share.h"

#include <gtest/gtest.h>

#include "support/patches.h"

namespace hemirad::test::seen_share_test {
namespace {

using Polygons = std::vector<Polygon>;

// `count` squares of a tenth in a row, side by side.
void add_row(Polygons& polygons, int count, glm::dvec3 at, glm::dvec3 u, glm::dvec3 v) {
    for (int i = 0; i < count; ++i) polygons.push_back(square(at + 0.1 * i * u, u, v, 0.1));
}

// Each sees the other row alone.
TEST(SeenShare, IsHalfOfTwoRowsThatFaceEachOther) {
    Polygons polygons;
    add_row(polygons, 200, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_row(polygons, 200, {20, 0, 1}, {-1, 0, 0}, {0, 1, 0});

    EXPECT_NEAR(seen_share(mesh_of(polygons)), 0.5, 0.02);
}

TEST(SeenShare, IsNothingWhereAllFaceAway) {
    Polygons polygons;
    add_row(polygons, 200, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});

    EXPECT_EQ(seen_share(mesh_of(polygons)), 0);
}

// A screen of two fronts between the rows hides each from the other: they see one front of it.
TEST(SeenShare, LeavesOutWhatIsHidden) {
    Polygons polygons;
    add_row(polygons, 200, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    add_row(polygons, 200, {20, 0, 1}, {-1, 0, 0}, {0, 1, 0});
    polygons.push_back(square({10, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, 100));
    polygons.push_back(square({10, 0, 0.5}, {0, 1, 0}, {1, 0, 0}, 100));

    EXPECT_LT(seen_share(mesh_of(polygons)), 0.01);
}

// A box's patches see those of the five other walls.
TEST(SeenShare, IsFiveSixthsInABox) {
    EXPECT_NEAR(seen_share(mesh_of(box({1, 1, 1}, 8))), 5.0 / 6, 0.02);
}

TEST(SeenShare, TakesOnePatch) {
    EXPECT_EQ(seen_share(mesh_of({square({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1)})), 0);
}

}  // namespace
}  // namespace hemirad::test::seen_share_test
