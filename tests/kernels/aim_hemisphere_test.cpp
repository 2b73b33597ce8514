#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/vec2.hpp>
#include <numbers>

#include <glm/geometric.hpp>

#include "support/kernel_run.h"
#include "support/patch_database.h"

namespace hemirad::test::aim_hemisphere_test {
namespace {

using glm::dvec2;
using glm::dvec3;

// Coordinates are below 1 in magnitude; a sample is an average of averages of them, less than 16
// roundings of half an ulp away from the exact one.
constexpr double kBound = 16 * 0x1p-24;

struct Frame {
    dvec3 origin, u_axis, v_axis, normal;
};

dvec3 vector_of(const float* v) { return {v[0], v[1], v[2]}; }

class AimHemisphere {
  public:
    explicit AimHemisphere(const PatchArrays& arrays)
        : arrays_(arrays), run_("aim_hemisphere", options(arrays)) {}

    Frame operator()(int patch, int samples, int part) {
        device::Shot shot{};
        shot.shooter = patch;
        shot.part = static_cast<std::uint32_t>(part);
        shot.status = kRunning;
        shot = aimed(shot, samples);
        EXPECT_EQ(shot.part, static_cast<std::uint32_t>(part + 1));
        EXPECT_EQ(shot.part_count, static_cast<std::uint32_t>(samples * samples));
        return {grid_point(shot.origin), vector_of(shot.u_axis), vector_of(shot.v_axis),
                vector_of(shot.normal)};
    }
    device::Shot aimed(const device::Shot& shot, int samples) {
        auto plural = run_.plural(std::vector{shot});
        run_.issue({1, 1}, plural, run_.plural(arrays_.corners), run_.plural(arrays_.normals),
                   run_.plural(arrays_.planes), run_.plural(arrays_.reached),
                   std::int32_t(arrays_.stride),
                   run_.plural(std::vector<std::int32_t>(arrays_.stride, samples)));
        return run_.acu().unload(plural).front();
    }

  private:
    static KernelOptions options(const PatchArrays& arrays) {
        KernelOptions result;
        result.corners = arrays.corner_count;
        return result;
    }

    PatchArrays arrays_;
    KernelRun run_;
};

dvec3 corner(const PatchArrays& arrays, int patch, int k) {
    return exact(corner_of(arrays, patch, std::min<std::size_t>(k, arrays.corner_count - 1)));
}

struct Part {
    double area;
    dvec3 centroid;
};

Part triangle_part(dvec3 a, dvec3 b, dvec3 c) {
    return {glm::length(glm::cross(b - a, c - a)) / 2, (a + b + c) / 3.0};
}

// A quad between four parameters of its bilinear map, as the two triangles it is made of.
Part quad_part(const PatchArrays& arrays, int patch, dvec2 least, dvec2 most) {
    const auto point = [&](double s, double t) {
        return (1 - t) * ((1 - s) * corner(arrays, patch, 0) + s * corner(arrays, patch, 1)) +
               t * ((1 - s) * corner(arrays, patch, 3) + s * corner(arrays, patch, 2));
    };
    const auto a = point(least.x, least.y), b = point(most.x, least.y), c = point(most.x, most.y),
               d = point(least.x, most.y);
    const auto low = triangle_part(a, b, c), high = triangle_part(a, c, d);
    const double area = low.area + high.area;
    return {area, (low.area * low.centroid + high.area * high.centroid) / area};
}

// By bisection, where `area` of the part below a parameter reaches `wanted`.
double parameter_of(const std::function<double(double)>& area, double wanted) {
    double low = 0, high = 1;
    for (int step = 0; step < 60; ++step) {
        const double middle = (low + high) / 2;
        (area(middle) < wanted ? low : high) = middle;
    }
    return low;
}

// Part `part` of samples x samples of equal area: rows of equal area, cut into equal cells.
Part equal_part(const PatchArrays& arrays, int patch, int samples, int part) {
    const double whole = quad_part(arrays, patch, {0, 0}, {1, 1}).area;
    const auto row_end = [&](int row) {
        return parameter_of(
            [&](double t) {
                return quad_part(arrays, patch, {0, 0}, {1, t}).area;
            },
            whole * row / samples);
    };
    const double t0 = row_end(part / samples), t1 = row_end(part / samples + 1);
    const auto cell_end = [&](int column) {
        return parameter_of(
            [&](double s) {
                return quad_part(arrays, patch, {0, t0}, {s, t1}).area;
            },
            whole / samples * column / samples);
    };
    return quad_part(arrays, patch, {cell_end(part % samples), t0},
                     {cell_end(part % samples + 1), t1});
}

// Centroids of the congruent triangles of a triangle cut into samples rows from corner a.
std::vector<dvec3> triangle_centroids(const PatchArrays& arrays, int patch, int samples) {
    const dvec3 a = corner(arrays, patch, 0), b = corner(arrays, patch, 1),
                c = corner(arrays, patch, 2);
    const auto point = [&](int down, int across) {
        return a + ((b - a) * double(down - across) + (c - a) * double(across)) / double(samples);
    };
    std::vector<dvec3> centroids;
    for (int row = 0; row < samples; ++row)
        for (int i = 0; i <= row; ++i) {
            if (i > 0)
                centroids.push_back(
                    triangle_part(point(row, i - 1), point(row + 1, i), point(row, i)).centroid);
            centroids.push_back(
                triangle_part(point(row, i), point(row + 1, i), point(row + 1, i + 1)).centroid);
        }
    return centroids;
}

bool repeats_corner(const PatchArrays& arrays, int patch) {
    return corner(arrays, patch, 3) == corner(arrays, patch, 2);
}

TEST(AimHemisphere, OriginIsTheCentroidOfOneOfTheEqualPartsOfAQuad) {
    const auto arrays = random_patches(20, 4, 3);
    AimHemisphere aim(arrays);

    for (const int samples : {1, 2, 5})
        for (int patch = 0; patch < 20; ++patch)
            for (int part = 0; part < samples * samples; ++part) {
                if (repeats_corner(arrays, patch)) continue;
                const auto expected = equal_part(arrays, patch, samples, part);
                const auto origin = aim(patch, samples, part).origin;
                // A part's own area decides how well the share of its two triangles is known.
                const double bound = kBound * std::max(1.0, 1e-3 / expected.area);
                ASSERT_LT(glm::distance(origin, expected.centroid), bound)
                    << "patch " << patch << " part " << part << " of " << samples;
            }
}

TEST(AimHemisphere, OriginIsTheCentroidOfThatPartOfATriangleOfThreeOrFourCorners) {
    for (const int corners : {3, 4}) {
        const auto arrays = random_patches(10, corners, 4);
        AimHemisphere aim(arrays);

        for (const int samples : {1, 2, 4})
            for (int patch = 0; patch < 10; ++patch) {
                if (!repeats_corner(arrays, patch)) continue;
                const auto centroids = triangle_centroids(arrays, patch, samples);
                for (int part = 0; part < samples * samples; ++part)
                    ASSERT_LT(glm::distance(aim(patch, samples, part).origin, centroids[part]),
                              kBound)
                        << "patch " << patch << " part " << part << " of " << samples;
            }
    }
}

// Multiples of 1/p and 1/p^2 with p^3 = p + 1, from 15 to 75 degrees.
double expected_angle(int patch, int part) {
    const double p = 1.3247179572447460;
    const double turn = (patch + 1) / p + part / (p * p);
    return (1.0 / 12 + (turn - std::floor(turn)) / 3) * std::numbers::pi;
}

TEST(AimHemisphere, TheFrameIsRightHandedAndEveryHemisphereTurnsItOtherwise) {
    const auto arrays = random_patches(50, 4, 5);
    AimHemisphere aim(arrays);

    for (int patch = 0; patch < 50; ++patch) {
        const int part = patch % 9;
        const auto frame = aim(patch, 3, part);

        const auto edge = corner(arrays, patch, 1) - corner(arrays, patch, 0);
        const auto normal = normal_of(arrays, patch);
        EXPECT_EQ(frame.normal, dvec3(normal.x, normal.y, normal.z));
        EXPECT_NEAR(glm::dot(frame.u_axis, frame.normal), 0, 4 * 0x1p-24);
        EXPECT_LT(glm::distance(glm::cross(frame.normal, frame.u_axis), frame.v_axis), 4 * 0x1p-24);
        EXPECT_NEAR(glm::length(frame.u_axis), 1, 4 * 0x1p-24);
        // Corners are rounded to half an ulp of 1; a short edge turns by as much more.
        const auto along = glm::normalize(edge);
        const double slope =
            glm::dot(frame.u_axis, glm::cross(frame.normal, along)) / glm::dot(frame.u_axis, along);
        EXPECT_NEAR(std::atan(slope), expected_angle(patch, part), 1e-5);
    }
}

TEST(AimHemisphere, AHaltedShotKeepsItsFrame) {
    const auto arrays = random_patches(1, 4, 6);
    device::Shot halted{};
    halted.status = kBinsFull;
    halted.origin[0] = 7;

    const auto shot = AimHemisphere(arrays).aimed(halted, 1);

    EXPECT_EQ(shot.origin[0], 7);
    EXPECT_EQ(shot.normal[2], 0.0f);
}

}  // namespace
}  // namespace hemirad::test::aim_hemisphere_test
