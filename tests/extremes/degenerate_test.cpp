#include <algorithm>
#include <numeric>

#include "extremes/sweep.h"
#include "solver/support.h"

// Straight on the device, past the mesher, which would drop or mend them: patches without area,
// twisted ones, cracks; and numbers of proxels and patches beyond a batch, a level or a group.
namespace hemirad::test::degenerate_test {
namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
const Polygon kFloor = square({0, 0, 0}, kX, kY, 1);

std::vector<Polygon> around(const std::vector<Polygon>& patches) {
    // Two far ones fix the extent and with it the shooter's frame.
    const Polygon far = square(9.0 * kX, kY, kZ, 18);
    return joined({kFloor, far, moved({far}, -18.0 * kX)[0]}, patches);
}

std::uint64_t count_of(const std::vector<int>& owners, int patch) {
    return static_cast<std::uint64_t>(std::ranges::count(owners, patch));
}

void expect_finite(ShotPipeline& pipeline) {
    for (const auto& projection : pipeline.projections()) {
        for (const auto& edge : projection.edge)
            for (const float value : edge) EXPECT_TRUE(std::isfinite(value));
        for (const float value : projection.depth) EXPECT_TRUE(std::isfinite(value));
    }
    for (const float factor : pipeline.factors()) EXPECT_TRUE(factor >= 0 && factor <= 1);
}

// Multiples of 2^-22: products of two are exact, and the area of three points of a line is 0.
glm::dvec3 rounded(const glm::dvec3& point) { return glm::round(point * 0x1p22) * 0x1p-22; }

// Points, and lines with their corners in any order, where the rays of proxels meet them.
TEST(Degenerate, PatchesWithoutAreaOwnNothing) {
    for (const auto mode : {FormFactorMode::count, FormFactorMode::analytic}) {
        Stage stage(128, mode);
        stage.show(around({}));
        const auto frame = stage.in_world(stage.aim(0));
        std::uint64_t owned = 0;
        for (int i = 0; i < 40; ++i) {
            const auto at =
                rounded(frame.origin + (0.1 + 0.2 * i) * ray_of(frame, 30 + i, 70 - i, 128));
            const auto along = rounded(0.1 * glm::cross(frame.normal, at));
            const auto a = at - along, b = at + 2.0 * along;
            const std::vector<Polygon> nothing = {
                quad(at, at, at, at), quad(a, b, b, b),  quad(a, a, b, b),  quad(a, b, a, b),
                quad(a, at, b, at),   quad(a, at, b, b), quad(b, at, a, a), quad(a, b, at, at)};
            for (const auto& polygon : nothing) ASSERT_EQ(reference::area(polygon), 0);
            stage.show(around(nothing));
            const auto owners = stage.owners_seen_by(0);
            for (int patch = 3; patch < 11; ++patch) owned += count_of(owners, patch);
            expect_finite(stage.pipeline());
        }
        EXPECT_EQ(owned, 0u);
    }
}

// What a twisted quad covers is not defined, but it does no harm: what it takes lies in its hull.
TEST(Degenerate, BowTiesAndDartsTakeNothingBesidesTheirHulls) {
    Stage stage(128, FormFactorMode::analytic);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> inside(-1, 1);
    for (int i = 0; i < 200; ++i) {
        std::array<glm::dvec3, 4> corners;
        for (auto& corner : corners)
            corner = {inside(random), inside(random), 1.5 + 0.1 * i / 200 * inside(random)};
        stage.show(around({{corners}}));
        const auto owners = stage.owners_seen_by(0);
        expect_finite(stage.pipeline());

        // Every triangle of the corners, both ways up.
        std::vector<Polygon> hull = around({});
        for (int k = 0; k < 4; ++k) {
            const auto &a = corners[k], &b = corners[(k + 1) % 4], &c = corners[(k + 2) % 4];
            hull.push_back({{a, b, c, c}});
            hull.push_back({{b, a, c, c}});
        }
        stage.show(hull);
        const auto truth = reference::project(stage.aim(0), stage.polygons(), 128, device_bound());
        std::uint64_t astray = 0;
        for (std::size_t proxel = 0; proxel < owners.size(); ++proxel)
            astray += owners[proxel] == 3 && truth.owner[proxel] < 3 && truth.decided(proxel);
        EXPECT_EQ(astray, 0u) << text(std::vector{Polygon{corners}});
    }
}

// Two halves of a ceiling about a proxel's ray, at distance 1 to 2. The margins seal a crack up to
// their own width; the first that lets light through is a figure.
// About a step of the grid, 1e-9: its edges have few bits of a direction, or none.
TEST(Degenerate, AShooterOfAGridStepSeesTheRoomAroundIt) {
    Stage stage(128);
    std::mt19937 random(31);
    for (const double side : {1e-8, 1e-9, 1e-10, 1e-12})
        for (int turn = 0; turn < 4; ++turn) {
            const auto rotation = random_rotation(random);
            auto polygons = box({1, 0.8, 0.6}, 2);
            polygons.insert(polygons.begin(), square({0.1, 0.2, 0.15}, {1, 0, 0}, {0, 1, 0}, side));
            stage.show(turned(polygons, rotation));

            EXPECT_EQ(stage.agreement_of(0).wrong, 0u) << side;
        }
}

TEST(Degenerate, CracksOfAnUlpAreSealed) {
    Stage stage(128);
    stage.show(around({}));
    const auto frame = stage.in_world(stage.aim(0));
    double least_open = 1;
    for (const double crack : {0.0, 0x1p-52, 1e-14, 1e-12, 1e-10, 1e-9, 1e-8, 0x1p-24, 1e-7, 3e-7,
                               1e-6, 2e-6, 3e-6, 4e-6, 6e-6, 1e-5, 1e-4, 1e-3}) {
        std::uint64_t escaped = 0;
        for (int i = 0; i < 64; ++i) {
            const auto ray = ray_of(frame, 32 + i, 33 + i / 2, 128);
            const auto u = glm::normalize(glm::cross(ray, {0.3, std::sin(i), std::cos(i)}));
            const auto v = glm::cross(ray, u), at = frame.origin + 2.0 * ray;
            const auto point = [&](double s, double t) { return at + s * u + t * v; };
            stage.show(around(
                {quad(point(crack, -1), point(crack, 0.7), point(1, 1), point(1, -0.8)),
                 quad(point(-crack, 0.7), point(-crack, -1), point(-1, -0.8), point(-1, 1))}));
            const auto owners = stage.owners_seen_by(0);
            const int owner = owners[std::size_t(33 + i / 2) * 128 + std::size_t(32 + i)];
            escaped += owner != 3 && owner != 4;
        }
        EXPECT_TRUE(escaped == 0 || crack > 0x1p-24) << crack << ": " << escaped;
        if (escaped > 0) least_open = std::min(least_open, crack);
        print("half width of a crack, over its distance", crack / 2,
              std::to_string(escaped) + " of 64 open");
    }
    EXPECT_LT(least_open, 1e-3);  // a real crack is one
}

// Owners against double precision for all numbers of proxels.
class Resolution : public testing::TestWithParam<std::uint32_t> {};
class LongResolution : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Small, Resolution, testing::Values(1, 16, 63, 333, 1024));
INSTANTIATE_TEST_SUITE_P(Large, LongResolution, testing::Values(2048, 4096, 8192));

void expect_agreement_at(std::uint32_t resolution) {
    Stage stage(resolution);
    std::mt19937 random(7);
    const auto rotation = [&] {
        std::normal_distribution<double> normal;
        const auto v = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
        const auto x = glm::normalize(v()), y = glm::normalize(glm::cross(v(), x));
        return glm::dmat3(x, y, glm::cross(x, y));
    }();
    auto polygons = box({3, 2, 1.25}, 2);
    for (const auto& polygon : soup(20, 0.8, 3)) polygons.push_back(polygon);
    stage.show(turned(polygons, rotation));
    const auto seen = stage.agreement_of(1);
    EXPECT_EQ(seen.wrong, 0u) << seen.first_wrong;
    EXPECT_EQ(seen.proxels, disk_proxel_count(resolution));
    print("resolution", resolution, text(seen));
}
TEST_P(Resolution, OwnersAreThoseOfDoublePrecision) { expect_agreement_at(GetParam()); }
TEST_P(LongResolution, OwnersAreThoseOfDoublePrecision) { expect_agreement_at(GetParam()); }

// A batch is 64 patches, a level one a PE, a group on this device 4,096 work-items at most.
class Patches : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Counts, Patches, testing::Values(1, 2, 4, 8, 27, 53));

TEST_P(Patches, BeyondABatchALevelAndAGroupAreAllProjected) {
    const auto walls = box({1, 0.7, 0.4}, GetParam());
    for (const auto& shape : {shapes().front(), shapes()[4]}) {
        Aimed aimed(walls, shape, 128);
        for (const int shooter : {0, int(walls.size() / 2), int(walls.size()) - 1}) {
            aimed.aim(shooter);
            aimed.project();
            const auto truth =
                reference::project(aimed.shooter(), aimed.polygons(), 128, device_bound());
            const auto seen = agreement(aimed.owners(), truth);
            EXPECT_EQ(seen.wrong, 0u) << walls.size() << " patches: " << seen.first_wrong;
            print("patches", double(walls.size()), text(seen));
        }
    }
}

}  // namespace
}  // namespace hemirad::test::degenerate_test
