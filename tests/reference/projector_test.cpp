#include "reference/projector.h"

#include <gtest/gtest.h>

#include <numbers>

#include "reference/closed_forms.h"
#include "tests/reference/views.h"

namespace hemirad::reference::projector_test {
namespace {

double fraction(const Truth& truth, int owner) {
    return double(truth.count(owner)) / double(disk_proxel_count(truth.resolution));
}

std::size_t proxel(int column, int row, int resolution) {
    return std::size_t(row) * resolution + column;
}

TEST(Disk, LeavesOutTheCornersOfASquareOfFour) {
    EXPECT_TRUE(in_disk(1, 0, 4));
    EXPECT_FALSE(in_disk(0, 0, 4));
    EXPECT_EQ(disk_proxel_count(4), 12u);
}

TEST(Disk, HoldsTheSmallestSquaresWhole) {
    EXPECT_EQ(disk_proxel_count(1), 1u);
    EXPECT_EQ(disk_proxel_count(2), 4u);
    EXPECT_EQ(disk_proxel_count(3), 9u);
}

TEST(Disk, TendsToPiQuarters) {
    EXPECT_NEAR(double(disk_proxel_count(1024)) / (1024.0 * 1024.0), std::numbers::pi / 4, 1e-4);
}

TEST(Projector, SeesAFacingSquareAsLargeAsItsClosedForm) {
    for (const int resolution : {64, 256, 1024}) {
        const Polygon square = ceiling(1, 1);

        const Truth truth = project(upward(), {{square}}, resolution);

        EXPECT_NEAR(fraction(truth, 0), closed_form(upward(), square), 0.5 / resolution);
    }
}

TEST(Projector, SeesPolygonsAcrossTheHorizonAsLargeAsTheirClosedForm) {
    int visible = 0;
    for (const Polygon& polygon : soup(100, 1.0, 3)) {
        const Truth truth = project(tilted(), {{polygon}}, 256);

        EXPECT_NEAR(fraction(truth, 0), closed_form(tilted(), polygon), 1.0 / 256);
        visible += truth.count(0) > 0;
    }
    EXPECT_GT(visible, 20);
}

TEST(Projector, PutsColumnsAlongUAndRowsAlongV) {
    const Polygon at_positive_u = ceiling(0.1, 1, {0.5, 0});
    const Polygon at_positive_v = ceiling(0.1, 1, {0, 0.5});
    const double sine = 0.5 / std::sqrt(1.25);
    const int off_centre = int((sine * 64 + 63) / 2);

    const Truth truth = project(upward(), {{at_positive_u, at_positive_v}}, 64);

    EXPECT_EQ(truth.owner[proxel(off_centre, 32, 64)], 0);
    EXPECT_EQ(truth.owner[proxel(32, off_centre, 64)], 1);
}

TEST(Projector, GivesEveryProxelOfTheDiskToARoomAroundIt) {
    for (const int resolution : {63, 64, 256}) {
        const Truth truth = project(tilted(), room({1, 0.7, 0.4}, 5), resolution);

        EXPECT_EQ(truth.count(kEscaped), 0u);
    }
}

TEST(Projector, LosesNoProxelBetweenPatchesWhoseEdgePassesThroughCentres) {
    // N odd puts proxels on u = 0 and v = 0, where the ceiling's quarters meet.
    const Truth truth = project(upward(), room({1, 1, 1}, 2), 65);

    EXPECT_EQ(truth.count(kEscaped), 0u);
}

TEST(Projector, CountsAndEscapedAddUpToTheDisk) {
    const auto triangles = soup(50, 0.4, 7);

    const Truth truth = project(tilted(), triangles, 128);

    std::uint64_t sum = truth.count(kEscaped);
    for (int index = 0; index < 50; ++index) sum += truth.count(index);
    EXPECT_EQ(sum, disk_proxel_count(128));
    EXPECT_EQ(sum + truth.count(kOutsideDisk), 128u * 128u);
    EXPECT_GT(truth.count(kEscaped), 0u);
}

TEST(Projector, LetsTheNearerPatchHideTheFarther) {
    const Polygon near = ceiling(1, 0.5);
    const Polygon far = ceiling(1, 1);

    const Truth far_first = project(upward(), {{far, near}}, 64);
    const Truth near_first = project(upward(), {{near, far}}, 64);

    EXPECT_EQ(far_first.count(0), 0u);
    EXPECT_EQ(near_first.count(1), 0u);
    EXPECT_EQ(far_first.count(1), near_first.count(0));
}

TEST(Projector, CutsIntersectingPatchesWhereTheyCross) {
    // Planes z = 1 + x and z = 1 - x cross on x = 0: each hides half of the other.
    const Polygon rising = quad({-.5, -.5, .5}, {-.5, .5, .5}, {.5, .5, 1.5}, {.5, -.5, 1.5});
    const Polygon falling = quad({-.5, -.5, 1.5}, {-.5, .5, 1.5}, {.5, .5, .5}, {.5, -.5, .5});

    const Truth truth = project(upward(), {{rising, falling}}, 64);

    EXPECT_GT(truth.count(0), 0u);
    EXPECT_EQ(truth.count(0), truth.count(1));
    EXPECT_EQ(truth.owner[proxel(20, 32, 64)], 0);
    EXPECT_EQ(truth.owner[proxel(43, 32, 64)], 1);
}

TEST(Projector, DoesNotSeeBackFaces) {
    const Truth truth = project(upward(), {{reversed(ceiling(1, 1))}}, 64, 1e-6);

    EXPECT_EQ(truth.count(kEscaped), disk_proxel_count(64));
    EXPECT_TRUE(truth.undecided.empty());
}

TEST(Projector, DoesNotSeeBelowTheHorizon) {
    const Polygon floor = reversed(ceiling(1, -0.5));

    const Truth truth = project(upward(), {{floor, reversed(floor)}}, 64, 1e-6);

    EXPECT_EQ(truth.count(kEscaped), disk_proxel_count(64));
    EXPECT_TRUE(truth.undecided.empty());
}

TEST(Projector, DoesNotSeeItsOwnPlane) {
    const Shooter shooter = tilted();
    const auto v_axis = glm::cross(shooter.normal, shooter.u_axis);
    const auto point = [&](double u, double v) {
        return shooter.origin + u * shooter.u_axis + v * v_axis;
    };
    std::vector<Polygon> plane;
    for (const double u : {-0.3, -0.1, 0.1})
        plane.push_back(quad(point(u, -.1), point(u + .2, -.1), point(u + .2, .1), point(u, .1)));

    const Truth truth = project(shooter, plane, 512, 1e-6);

    EXPECT_EQ(truth.count(kEscaped), disk_proxel_count(512));
    EXPECT_TRUE(truth.undecided.empty());
}

TEST(Projector, GivesTiesToTheLowestIndex) {
    const Polygon square = ceiling(1, 1);

    const Truth truth = project(upward(), {{square, square, square}}, 64);

    EXPECT_GT(truth.count(0), 0u);
    EXPECT_EQ(truth.count(1) + truth.count(2), 0u);
}

TEST(ProjectorBound, LeavesTiesUndecidedBetweenThoseThatTie) {
    const Polygon square = ceiling(1, 1);
    const std::size_t middle = proxel(32, 32, 64);

    const Truth truth = project(upward(), {{ceiling(1, 2), square, square}}, 64, 1e-6);

    EXPECT_EQ(truth.undecided.at(middle), (std::vector<int>{1, 2}));
    EXPECT_FALSE(truth.decided(middle));
    EXPECT_TRUE(truth.admits(middle, 1) && truth.admits(middle, 2));
    EXPECT_FALSE(truth.admits(middle, 0) || truth.admits(middle, kEscaped));
}

TEST(ProjectorBound, DecidesDepthsThatDifferByMoreThanTwiceTheBound) {
    const std::size_t middle = proxel(32, 32, 64);
    const Polygon square = ceiling(1, 1);

    const auto at = [&](double gap) {
        return project(upward(), {{ceiling(1, 1 + gap), square}}, 64, 1e-6).decided(middle);
    };

    EXPECT_TRUE(at(2.1e-6));
    EXPECT_FALSE(at(1.9e-6));
}

TEST(ProjectorBound, DecidesRaysThatPassAnEdgeByMoreThanTheBound) {
    // The left edge is at x = gap; the middle column of an odd plane has u = 0.
    const auto at = [](double gap) {
        return project(upward(), {{ceiling(0.5, 1, {0.5 + gap, 0})}}, 65, 1e-6);
    };
    const std::size_t middle = proxel(32, 32, 65);

    EXPECT_TRUE(at(1.1e-6).decided(middle));
    EXPECT_EQ(at(1.1e-6).owner[middle], kEscaped);
    EXPECT_EQ(at(0.9e-6).undecided.at(middle), (std::vector<int>{kEscaped, 0}));
    EXPECT_EQ(at(-0.9e-6).undecided.at(middle), (std::vector<int>{kEscaped, 0}));
    EXPECT_TRUE(at(-1.1e-6).decided(middle));
    EXPECT_EQ(at(-1.1e-6).owner[middle], 0);
}

TEST(ProjectorBound, GrowsWithTheDistanceOfAPolygonsFarthestPoint) {
    // Two ceilings of one shape in the eye of the shooter, a thousand times as far: the same ray
    // passes the left edge by the same angle.
    const auto at = [](double gap, double height) {
        const Polygon shifted = ceiling(0.5 * height, height, {(0.5 + gap) * height, 0});
        return project(upward(), {{shifted}}, 65, Bound{.relative = 1e-6})
            .decided(proxel(32, 32, 65));
    };
    const double farthest = std::sqrt(2.25);  // sqrt(1 + 1 + 0.25)

    for (const double height : {1e-3, 1.0, 1e3}) {
        EXPECT_TRUE(at(1.01e-6 * farthest, height)) << height;
        EXPECT_FALSE(at(0.99e-6 * farthest, height)) << height;
    }
}

TEST(ProjectorBound, LeavesASmallPatchWithItsSideWhereItsNormalIsKnown) {
    // As small as the bound: its corners alone would not tell front from back.
    const Polygon back = reversed(ceiling(1e-6, 1));
    const std::size_t middle = proxel(32, 32, 65);

    const Truth by_corners = project(upward(), {{back}}, 65, Bound{1e-6, 0});
    const Truth by_normal = project(upward(), {{back}}, 65, Bound{1e-6, 0, 1e-6});

    EXPECT_TRUE(by_corners.admits(middle, 0));
    EXPECT_FALSE(by_normal.admits(middle, 0));
}

TEST(ProjectorBound, FindsEdgesOfSmallFarPolygonsWhereTheyAre) {
    // A triangle of size 1e-9 at distance 1, whose first edge passes a ray by a tenth of that:
    // products of its corners, of relative error 1e-16 each, would leave it to chance.
    for (int column = 8; column < 56; ++column) {
        const double u = double(2 * column + 1 - 64) / 64, v = 1.0 / 64;
        const glm::dvec3 ray(u, v, std::sqrt(1 - u * u - v * v));
        const glm::dvec3 across = glm::normalize(glm::cross(ray, glm::dvec3(0.3, 0.9, 0.1)));
        const glm::dvec3 along = glm::cross(ray, across);
        const auto is_hit = [&](double gap) {
            const auto point = [&](double s, double t) {
                return ray + 1e-9 * (s * along + (t + gap) * across);
            };
            const Polygon small = triangle(point(-0.5, 0), point(0.5, 0), point(0, 1));
            const Truth truth = project(upward(), {{small, reversed(small)}}, 64,
                                        Bound{.relative = kProjectorRounding});
            return truth.owner[proxel(column, 32, 64)] != kEscaped;
        };

        EXPECT_TRUE(is_hit(-0.1)) << column;
        EXPECT_FALSE(is_hit(0.1)) << column;
    }
}

TEST(ProjectorBound, AdmitsWhatLiesBehindAMarginalHit) {
    const std::size_t middle = proxel(32, 32, 65);

    const Truth truth =
        project(upward(), {{ceiling(0.5, 1, {0.5, 0}), ceiling(2, 2), ceiling(2, 3)}}, 65, 1e-6);

    EXPECT_EQ(truth.undecided.at(middle), (std::vector<int>{0, 1}));
}

TEST(ProjectorBound, LeavesAWallUndecidedWhosePlaneHoldsTheOrigin) {
    const Polygon wall = quad({0, -1, 0}, {0, 1, 0}, {0, 1, 1}, {0, -1, 1});
    const std::size_t on_the_plane = proxel(32, 32, 65);

    const Truth truth = project(upward(), {{wall}}, 65, 1e-6);

    EXPECT_TRUE(truth.admits(on_the_plane, 0));
    EXPECT_TRUE(truth.admits(on_the_plane, kEscaped));
    EXPECT_EQ(truth.count(0), 0u);
    EXPECT_TRUE(truth.decided(proxel(33, 32, 65)));
}

TEST(ProjectorBound, ChangesNoOwner) {
    const auto triangles = soup(100, 0.3, 11);

    EXPECT_EQ(project(tilted(), triangles, 128, 0).owner,
              project(tilted(), triangles, 128, 1e-3).owner);
}

TEST(ProjectorBound, AdmitsEveryOwner) {
    const auto triangles = soup(100, 0.3, 12);

    const Truth truth = project(tilted(), triangles, 128, 1e-3);

    EXPECT_GT(truth.undecided.size(), 0u);
    for (const auto& [where, owners] : truth.undecided) {
        EXPECT_GE(owners.size(), 2u);
        EXPECT_TRUE(truth.admits(where, truth.owner[where]));
    }
}

TEST(ProjectorBound, NeedsTheOriginClearOfThePolygonToBeSure) {
    const std::size_t middle = proxel(32, 32, 64);

    const Truth touching = project(upward(), {{ceiling(1, 0.9e-6)}}, 64, 1e-6);
    const Truth clear = project(upward(), {{ceiling(1, 1e-5)}}, 64, 1e-6);

    EXPECT_TRUE(touching.admits(middle, kEscaped));
    EXPECT_TRUE(clear.decided(middle));
}

double at(const Bound& bound, double distance) {
    return bound.relative * distance + bound.absolute;
}

std::vector<Polygon> displaced(std::vector<Polygon> triangles, const glm::dvec3& origin,
                               const Bound& bound, std::mt19937& random) {
    for (Polygon& polygon : triangles) {
        for (int k = 0; k < 3; ++k) {
            const double by = at(bound, glm::distance(polygon.corners[k], origin));
            polygon.corners[k] += by * glm::normalize(random_point(random, 1));
        }
        polygon.corners[3] = polygon.corners[2];
    }
    return triangles;
}

// In general position, in the plane of a triangle, or barely above one.
Shooter somewhere(const std::vector<Polygon>& triangles, unsigned seed) {
    Shooter shooter = tilted();
    const auto& c = triangles[0].corners;
    if (seed % 3 == 1) shooter.origin = c[0] + 1.7 * (c[1] - c[0]) + 0.3 * (c[2] - c[0]);
    if (seed % 3 == 2) shooter.origin = (c[0] + c[1] + c[2]) / 3.0 + 0.05 * normal(triangles[0]);
    return shooter;
}

// The bound is a promise: displace every vertex by it, and each owner must be admissible.
TEST(ProjectorBound, AdmitsTheOwnersOfDisplacedPolygons) {
    const double sizes[] = {0.02, 0.2, 0.8, 2};
    const Bound bounds[] = {{0, 1e-4}, {0, 3e-3}, {0, 3e-2}, {1e-4, 0}, {3e-3, 1e-5}, {3e-2, 0}};
    for (const Bound& bound : bounds) {
        std::uint64_t changed = 0, refused = 0;
        for (unsigned seed = 0; seed < 96; ++seed) {
            const auto triangles = soup(40, sizes[seed % 4], seed);
            const Shooter shooter = somewhere(triangles, seed);
            std::mt19937 random(seed);

            const Truth truth = project(shooter, triangles, 64, bound);
            const Truth moved =
                project(shooter, displaced(triangles, shooter.origin, bound, random), 64);

            for (std::size_t where = 0; where < moved.owner.size(); ++where) {
                changed += moved.owner[where] != truth.owner[where];
                refused += !truth.admits(where, moved.owner[where]);
            }
        }
        EXPECT_GT(changed, 0u);
        EXPECT_EQ(refused, 0u) << bound.relative << " r + " << bound.absolute;
    }
}

TEST(ProjectorBound, LeavesFewProxelsUndecided) {
    const auto triangles = soup(1000, 0.2, 5);

    const Truth truth = project(tilted(), triangles, 512, 1e-6);

    EXPECT_LT(double(truth.undecided.size()), 1e-4 * double(disk_proxel_count(512)));
}

}  // namespace
}  // namespace hemirad::reference::projector_test
