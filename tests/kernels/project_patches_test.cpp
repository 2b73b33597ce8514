#include <gtest/gtest.h>

#include <algorithm>

#include "reference/projector.h"
#include "support/pipeline.h"

namespace hemirad::test::project_patches_test {
namespace {

// What single precision may move an edge or a plane by, on either side (kEdgeMargin), twice: the
// reference's bound is on each side of the nominal edge, the device's margin on one.
constexpr double kBound = 2 * kEdgeMargin;

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0);

std::int64_t owned_by(const std::vector<int>& owners, int patch) {
    return std::count(owners.begin(), owners.end(), patch);
}

// Whole tiles, and tiles cut off by the edge of the plane; each resolution is compiled for anew.
class ProjectPatches : public testing::TestWithParam<Shape> {
  protected:
    std::vector<int> owners_seen_by_first(const std::vector<Polygon>& polygons, int resolution) {
        Aimed aimed(polygons, GetParam(), resolution);
        aimed.aim(0);
        aimed.project();
        return aimed.owners();
    }
};

INSTANTIATE_TEST_SUITE_P(Shapes, ProjectPatches, testing::ValuesIn(shapes()),
                         [](const auto& shape) { return name_of(shape.param); });

TEST_P(ProjectPatches, NearerPatchHidesFarther) {
    const auto floor = square({0, 0, 0}, kX, kY, 1);
    const auto far = square({0, 0, 2}, kY, kX, 1), near = square({0, 0, 1}, kY, kX, 2);

    const auto owners = owners_seen_by_first({floor, far, near}, 100);

    EXPECT_EQ(owned_by(owners, 1), 0);
    // Centre of a square of side 2 at distance 1, Lambert: 4 / (pi sqrt 2) * atan(1 / sqrt 2).
    EXPECT_NEAR(static_cast<double>(owned_by(owners, 2)) / disk_proxel_count(100), 0.5541, 5e-3);
}

TEST_P(ProjectPatches, ATieGoesToTheLowestPatch) {
    const auto floor = square({0, 0, 0}, kX, kY, 1), ceiling = square({0, 0, 1}, kY, kX, 2);

    const auto owners = owners_seen_by_first({floor, ceiling, ceiling, ceiling}, 100);

    EXPECT_GT(owned_by(owners, 1), 0);
    EXPECT_EQ(owned_by(owners, 2) + owned_by(owners, 3), 0);
}

TEST_P(ProjectPatches, EveryProxelInTheDiskHasOneOwner) {
    const auto owners = owners_seen_by_first(soup(100, 0.3, 1), 100);

    EXPECT_EQ(100 * 100 - owned_by(owners, reference::kOutsideDisk),
              static_cast<std::int64_t>(disk_proxel_count(100)));
}

TEST_P(ProjectPatches, NothingEscapesFromAClosedBox) {
    for (const int patch : {0, 7, 40, 95}) {
        Aimed aimed(box({1, 0.7, 0.3}, 4), GetParam(), 512);
        aimed.aim(patch);
        aimed.project();

        EXPECT_EQ(owned_by(aimed.owners(), reference::kEscaped), 0) << "shooter " << patch;
    }
}

TEST_P(ProjectPatches, OwnersAgreeWithTheScalarReference) {
    std::size_t undecided = 0;
    for (const int patches : {1, 10, 1000})
        for (const int resolution : {100, 512}) {
            Aimed aimed(soup(patches, patches > 100 ? 0.2 : 0.6, patches), GetParam(), resolution);
            aimed.aim(0);
            aimed.project();
            const auto truth =
                reference::project(aimed.shooter(), aimed.polygons(), resolution, kBound);
            const auto owners = aimed.owners();

            for (std::size_t proxel = 0; proxel < owners.size(); ++proxel) {
                if (truth.decided(proxel))
                    ASSERT_EQ(owners[proxel], truth.owner[proxel]) << "proxel " << proxel;
                else
                    ASSERT_TRUE(truth.admits(proxel, owners[proxel])) << "proxel " << proxel;
            }
            undecided += truth.undecided.size();
        }
    RecordProperty("undecided_proxels", static_cast<int>(undecided));
    EXPECT_LT(undecided, 100u);
}

// Far smaller than a proxel's distance to the margins of their arcs, which overshoot at sharp
// corners: what an array evaluates beyond a bounding rectangle must not count.
TEST(OwnersOfTinyPatches, AreTheSameForEveryArray) {
    auto polygons = box({1, 1, 1}, 1);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> inside(-1, 1);
    const auto point = [&] { return glm::dvec3(inside(random), inside(random), inside(random)); };
    for (int i = 0; i < 3000; ++i) {
        const auto centre = glm::dvec3(-0.97, 0, 0) + 0.02 * point();
        const auto a = centre + 5e-4 * point(), b = centre + 5e-4 * point();
        polygons.push_back({{centre, a, b, b}});
    }
    std::vector<int> first;
    for (const auto& shape : shapes()) {
        Aimed aimed(polygons, shape, 512);
        aimed.aim(0);
        aimed.project();

        const auto owners = aimed.owners();

        if (first.empty()) first = owners;
        EXPECT_TRUE(owners == first) << shape;
    }
}

}  // namespace
}  // namespace hemirad::test::project_patches_test
