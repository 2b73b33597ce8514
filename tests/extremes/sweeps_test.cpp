#include <algorithm>

#include "extremes/sweep.h"
#include "reference/closed_forms.h"
#include "solver/support.h"

// Sizes, distances, shapes and places, each taken to its extreme: owners against double precision.
namespace hemirad::test::sweeps_test {
namespace {

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);
constexpr int kTurns = 6;  // random rotations a value
constexpr int kRays = 24;

const Polygon kFloor = square({0, 0, 0}, kX, kY, 1);  // of size 1, front up

std::vector<Polygon> solid(const glm::dvec3& low, const glm::dvec3& high) {
    std::vector<Polygon> polygons;
    for (const auto& face : solid_box(low, high))
        polygons.push_back(quad(face[0], face[1], face[2], face[3]));
    return polygons;
}

/// A hall of 6 x 4 x 2.5 with a crate on its floor, a board above it and a pillar.
std::vector<Polygon> hall() {
    auto polygons = box({3, 2, 1.25}, 2);
    polygons = joined(polygons, solid({-2, -1, -1.25}, {-1.3, -0.1, -0.45}));
    polygons = joined(polygons, solid({-2.2, -1.1, -0.15}, {-0.9, 0.2, -0.1}));
    return joined(polygons, solid({1.2, 0.3, -1.25}, {1.6, 0.7, 0.95}));
}

class Sweep : public testing::Test {
  protected:
    Agreement seen_by(const std::vector<Polygon>& polygons, const std::vector<int>& shooters) {
        stage_.show(polygons);
        Agreement all;
        for (const int shooter : shooters) all += stage_.agreement_of(shooter);
        return all;
    }
    /// What patch 0 sees, the scene turned at random.
    Agreement seen_by_first(const std::vector<Polygon>& polygons) {
        Agreement all;
        for (int turn = 0; turn < kTurns; ++turn)
            all += seen_by(turned(polygons, random_rotation(random_)), {0});
        return all;
    }
    using Around =
        std::function<std::vector<Polygon>(const glm::dvec3& origin, const glm::dvec3& ray)>;
    /// What patch 0 sees of what is put around rays of its proxels, one ray at a time.
    Agreement seen_around_rays(const Around& around) {
        const Polygon far = square(9.0 * kX, kY, kZ, 18);  // fixes the extent
        const auto base =
            turned({kFloor, far, moved({far}, -18.0 * kX)[0]}, random_rotation(random_));
        stage_.show(base);
        const auto frame = stage_.in_world(stage_.aim(0));
        Agreement all;
        for (int i = 0; i < kRays; ++i) {
            const int column = int(uniform(15, 113)), row = int(uniform(40, 88));
            const auto ray = ray_of(frame, column, row, stage_.resolution());
            all += seen_by(joined(base, around(frame.origin, ray)), {0});
        }
        return all;
    }
    glm::dvec3 across(const glm::dvec3& ray) {
        return glm::normalize(glm::cross(ray, {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}));
    }
    int whole(int below) { return int(random_() % unsigned(below)); }
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

    Stage stage_{128};
    std::mt19937 random_{1};
};

TEST_F(Sweep, WorldsOfMicrometresAndOfThousandsOfKilometres) {
    const auto turned_hall = turned(hall(), random_rotation(random_));
    expect_agreement("size of the world", powers_of_ten(-6, 6), [&](double size) {
        return seen_by(scaled(turned_hall, 1.37 * size), {0, 5, 13, 26, 31, 40});
    });
}

TEST_F(Sweep, WorldsFarFromTheOrigin) {
    const auto turned_hall = turned(hall(), random_rotation(random_));
    const glm::dvec3 towards = glm::normalize(glm::dvec3(0.6, -0.3, 0.7));
    expect_agreement("offset in sizes of the world", powers_of_ten(0, 7), [&](double offset) {
        return seen_by(moved(turned_hall, 6 * offset * towards), {0, 5, 13, 26, 31, 40});
    });
}

// The ray passes between two of them.
TEST_F(Sweep, SliversThatTileACeiling) {
    expect_agreement("aspect of a sliver", powers_of_ten(0, 6), [&](double aspect) {
        return seen_around_rays([&](const glm::dvec3& origin, const glm::dvec3& ray) {
            const auto u = across(ray), v = glm::cross(ray, u);
            const auto point = [&](double s, double t) {
                return origin + 2.0 * ray + s / aspect * u + t * v;
            };
            std::vector<Polygon> slivers;
            for (int i = -10; i < 10; ++i)
                slivers.push_back(
                    quad(point(i, -0.4), point(i, 0.6), point(i + 1, 0.6), point(i + 1, -0.4)));
            return slivers;
        });
    });
}

// The ray passes along the edge of two, or close by where they meet.
TEST_F(Sweep, SliverTrianglesThatShareACorner) {
    expect_agreement("aspect of a triangle", powers_of_ten(0, 6), [&](double aspect) {
        return seen_around_rays([&](const glm::dvec3& origin, const glm::dvec3& ray) {
            const auto u = across(ray), v = glm::cross(ray, u);
            const double beyond = std::pow(10, uniform(-9, -1));
            const glm::dvec3 tip = origin + 2.0 * ray - (whole(2) == 0 ? beyond : -beyond) * u;
            const auto at = [&](int i) {
                return tip + std::cos(i / aspect) * u + std::sin(-i / aspect) * v + 0.1 * ray;
            };
            std::vector<Polygon> slivers;
            for (int i = -3; i < 3; ++i) slivers.push_back({{tip, at(i), at(i + 1), at(i + 1)}});
            return slivers;
        });
    });
}

// About a proxel's own ray, so that the smallest are seen, too.
TEST_F(Sweep, PatchesFromAMillionthOfAProxelToTheWholeHemisphere) {
    expect_agreement("size in proxels", powers_of_ten(-6, 3), [&](double size) {
        return seen_around_rays([&](const glm::dvec3& origin, const glm::dvec3& ray) {
            const auto u = across(ray);
            const double side = 3.0 * size * 2 / stage_.resolution();
            const auto middle = origin + 3.0 * ray + uniform(-0.7, 0.7) * side * u;
            return std::vector{square(middle, u, glm::cross(u, ray), side),
                               square(middle + 0.1 * ray, u, glm::cross(u, ray), 0.3 * side),
                               square(middle + 0.2 * ray, u, glm::cross(u, ray), 1)};
        });
    });
}

// Walls and ceilings whose lower edge is as high above the shooter's plane, and as far below.
TEST_F(Sweep, PatchesCloseToTheShootersPlane) {
    auto heights = powers_of_ten(-1, -12);
    heights.push_back(0);
    expect_agreement("height over the shooter's plane", heights, [&](double height) {
        std::vector<Polygon> polygons = {kFloor};
        for (const double h : {height, -height}) {
            const double x = h > 0 ? 1 : -1;
            polygons.push_back(quad({x, -1, h}, {x, -x, h}, {x, x, h + 1}, {x, -1, h + 1}));
            polygons.push_back(quad({-1, x, h - 1}, {1, x, h - 1}, {1, x, h}, {-1, x, h}));
        }
        polygons.push_back(square({0.3, 0.1, height}, kY, kX, 0.5));
        polygons.push_back(square({0, 0, -height}, kY, kX, 0.5));
        polygons.push_back(square({0, 3, height}, kX, kY, 0.5));
        return seen_by_first(polygons);
    });
}

// One patch wide, and cut into 49: of the whole hemisphere or nothing, as cull_patches has it,
// which takes what is lower than kPlaneMargin of a corner's distance for touching.
TEST_F(Sweep, CeilingsAreSeenDownToWhereTheyTouch) {
    for (const int cells : {1, 7}) {
        double lowest_seen = 1;
        for (const double height : powers_of_ten(-1, -12)) {
            std::vector<Polygon> polygons = {kFloor};
            const double side = 2.0 / cells;
            for (int i = 0; i < cells * cells; ++i)
                polygons.push_back(
                    square({(i % cells + 0.5) * side - 1, (i / cells + 0.5) * side - 1, height}, kY,
                           kX, side));
            stage_.show(turned(polygons, random_rotation(random_)));
            const auto owners = stage_.owners_seen_by(0);
            const auto seen = static_cast<double>(
                std::ranges::count_if(owners, [](int owner) { return owner > 0; }));
            const double part = seen / double(disk_proxel_count(128));
            if (part > 0) lowest_seen = height;
            print(cells == 1 ? "height of a ceiling over its half width"
                             : "height of a ceiling of 49 patches",
                  height, std::to_string(part) + " of the hemisphere");
            const double corner = std::numbers::sqrt2 / cells;  // the nearest patch's, in world
            const bool apart = height > 2 * kPlaneMargin * corner + 4 * kGridMargin;
            EXPECT_TRUE(part > 0.98 || !apart || height > 0.05) << height << ": " << part;
        }
        EXPECT_LT(lowest_seen, 1e-5);
        EXPECT_GT(lowest_seen, 1e-9);
    }
}

// Hinged on the shooter's edge and corner, from flat on it to flat beside it.
TEST_F(Sweep, PatchesThatShareAnEdgeOrACornerWithTheShooter) {
    const double pi = std::numbers::pi;
    std::vector<double> angles = powers_of_ten(-9, -1);
    for (const double angle : {0.0, 0.5, 1.5, pi / 2, 3.0}) angles.push_back(angle);
    for (const double angle : powers_of_ten(-1, -9)) angles.push_back(pi - angle);
    expect_agreement("angle at the shared edge", angles, [&](double angle) {
        std::vector<Polygon> polygons = {kFloor};
        const glm::dvec3 up(-std::cos(angle), 0, std::sin(angle));
        const glm::dvec3 a(0.5, -0.5, 0), b(0.5, 0.5, 0);
        polygons.push_back(quad(b, a, a + up, b + up));
        polygons.push_back(quad(a, b, b + up, a + up));
        const glm::dvec3 c(-0.5, 0.5, 0);
        const auto d = c + glm::dvec3(-std::cos(angle), -0.2, std::sin(angle));
        polygons.push_back({{c, d, d + kY, d + kY}});
        polygons.push_back({{c, d + kY, d, d}});
        return seen_by_first(polygons);
    });
}

// The ray lies at this angle to their planes; smaller ones before and behind face it.
TEST_F(Sweep, PatchesSeenNearlyEdgeOn) {
    expect_agreement("angle of sight", powers_of_ten(-1, -9), [&](double angle) {
        return seen_around_rays([&](const glm::dvec3& origin, const glm::dvec3& ray) {
            const auto u = across(ray), v = glm::cross(ray, u);
            const auto along = std::cos(angle) * ray + std::sin(angle) * v;
            const auto point = [&](double s, double t) {
                return origin + 2.0 * ray + s * along + t * u;
            };
            std::vector<Polygon> patches;
            for (const double side : {-1.0, 1.0}) {
                patches.push_back(quad(point(-1, -0.3 * side), point(-1, 0.3 * side),
                                       point(1, 0.3 * side), point(1, -0.3 * side)));
                patches.push_back(quad(point(0.1, -0.2 * side), point(0.1, 0.2 * side),
                                       point(0.5, 0.2 * side), point(0.5, -0.2 * side)));
            }
            for (const double distance : {0.5, 1.5, 2.5, 4.0})
                patches.push_back(square(origin + distance * ray, u, -v, 0.02));
            return patches;
        });
    });
}

TEST_F(Sweep, PatchesFromATenMillionthOfTheShootersSizeToTenMillionTimesAsFar) {
    expect_agreement("distance in sizes of the shooter", powers_of_ten(-7, 7), [&](double far) {
        std::vector<Polygon> polygons = {kFloor};
        const auto at = [&](double x, double y, double z) { return far * glm::dvec3(x, y, z); };
        polygons.push_back(square(at(0.1, 0.2, 1), kY, kX, 0.5 * far));
        polygons.push_back(square(at(0.2, 0.1, 2), kY, kX, far));
        polygons.push_back(quad(at(1, -1, -0.5), at(1, -1, 0.7), at(1, 1, 0.7), at(1, 1, -0.5)));
        polygons.push_back(square(at(-0.4, -0.4, 1.1), kY, kX, 1));
        return seen_by_first(polygons);
    });
}

TEST_F(Sweep, CoplanarCoincidentInterpenetratingAndDuplicatedPatches) {
    auto gaps = powers_of_ten(-1, -12);
    gaps.push_back(0);
    expect_agreement("gap between parallel patches", gaps, [&](double gap) {
        std::vector<Polygon> polygons = {kFloor};
        const auto ceiling = square({0.1, 0.1, 0.8}, kY, kX, 0.9);
        polygons.push_back(ceiling);
        polygons.push_back(moved({ceiling}, {0.2, 0.1, gap}).front());
        polygons.push_back(moved({ceiling}, {-0.2, 0.3, -gap}).front());
        polygons.push_back(ceiling);
        const glm::dvec3 a(-1, -1, 0.6), b(-1, 1, 0.6), c(1, 1, 1.2 + gap), d(1, -1, 1.2 + gap);
        polygons.push_back(quad(a, b, c, d));
        const glm::dvec3 e(-1, -1, 1.2), f(-1, 1, 1.2), g(1, 1, 0.6 + gap), h(1, -1, 0.6 + gap);
        polygons.push_back(quad(e, f, g, h));
        return seen_by_first(polygons);
    });
}

// Against closed forms: what the bottom of an open cup sees of its walls, where the cup is as large
// as this part of the hall. The grid's q moves each corner, and with it each of a wall's four
// angles by q / distance at either end, of which the sum over 2 pi counts: 8 q / (2 pi size / 2).
TEST(SweepOfFactors, OfATinyCupInALargeHall) {
    Stage stage(64, FormFactorMode::analytic);
    std::mt19937 random(3);
    for (const double size : powers_of_ten(-1, -9)) {
        double worst = 0;
        for (int turn = 0; turn < kTurns; ++turn) {
            const auto walls = box(glm::dvec3(0.5), 1);
            std::vector<Polygon> cup;  // the floor first, and no lid
            for (const std::size_t wall : {4, 0, 1, 2, 3}) cup.push_back(walls[wall]);
            cup = turned(scaled(cup, size), random_rotation(random));
            cup = moved(cup, {0.31, -0.23, 0.17});
            stage.show(joined(cup, box(glm::dvec3(0.5), 1)));
            stage.owners_seen_by(0);
            const auto factors = stage.pipeline().factors();
            for (std::size_t wall = 1; wall < 5; ++wall) {
                const double exact =
                    reference::point_to_polygon((cup[0].corners[0] + cup[0].corners[2]) / 2.0,
                                                reference::normal(cup[0]), cup[wall].corners);
                const std::size_t at = kUnblockedFactor * stage.pipeline().stride() + wall;
                worst = std::max(worst, std::abs(double(factors[at]) - exact));
            }
        }
        std::ostringstream out;
        out << "factor off by " << worst << " at most, of about 0.2";
        print("size of an object in a hall", size, out.str());
        const double q = std::sqrt(3.0) * 0x1p-31;
        EXPECT_LT(worst, 1e-5 + 16 * q / (std::numbers::pi * size * 0.5)) << size;
    }
}

}  // namespace
}  // namespace hemirad::test::sweeps_test
