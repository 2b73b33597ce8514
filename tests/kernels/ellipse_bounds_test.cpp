#include <gtest/gtest.h>

#include <random>

#include "kernels/shared.h"
#include "support/exact_bounds.h"

namespace hemirad::test::ellipse_bounds_test {
namespace {

constexpr std::size_t kArcs = 100000;  // a multiple of sixteen

struct Arcs {
    std::vector<Float3> from, to;
};

// Ends in the half ball of the normalised world's diameter above the shooter.
class ArcMaker {
  public:
    explicit ArcMaker(unsigned seed) : random_(seed) {}

    std::pair<Float3, Float3> arc(std::size_t kind) {
        auto a = rounded(point()), b = rounded(point());
        switch (kind % 10) {
            case 0:
                return {a, b};
            case 1:
                return along_axis(a, b, 0);
            case 2:
                return along_axis(a, b, 1);
            case 3:
                return along_axis(a, b, 2);  // C = 0, as is every vertical edge
            case 4:
                a[0] = 0;
                return {a, b};  // begins at u = 0
            case 5:
                a[1] = b[1] = 0;
                return {a, b};  // along v = 0
            case 6:
                return {a, nearby(a, 1e-3f)};
            case 7:
                return {a, nearby(a, 0.05f)};
            case 8:
                a[2] *= 1e-4f;
                b[2] *= 1e-4f;
                return {a, b};  // along the horizon
            default:
                b[0] = -0.5f * a[0];
                b[1] = -0.5f * a[1];
                return {a, b};  // C = 0, over the pole
        }
    }

  private:
    glm::dvec3 point() {
        return {3 * coordinate_(random_), 3 * coordinate_(random_), std::abs(coordinate_(random_))};
    }
    static std::pair<Float3, Float3> along_axis(const Float3& a, const Float3& other, int axis) {
        auto b = a;
        b[axis] = other[axis];
        return {a, b};
    }
    Float3 nearby(const Float3& a, float size) {
        auto b = a;
        for (float& c : b) c += size * static_cast<float>(coordinate_(random_));
        b[2] = std::abs(b[2]);
        return b;
    }

    std::mt19937 random_;
    std::uniform_real_distribution<double> coordinate_{-1, 1};
};

// Edges of patches that a shooter sees do not point at it: their lines pass it at a distance.
Arcs random_arcs(std::size_t count, double least_moment, unsigned seed) {
    ArcMaker maker(seed);
    Arcs arcs;
    for (std::size_t kind = 0; arcs.from.size() < count; ++kind) {
        const auto [a, b] = maker.arc(kind);
        const auto d = exact(b) - exact(a);
        if (glm::length(glm::cross(exact(a), d)) < least_moment * glm::length(d)) continue;
        arcs.from.push_back(a);
        arcs.to.push_back(b);
    }
    return arcs;
}

DeviceBounds bounds_of(const Arcs& arcs, std::uint32_t lanes, std::uint32_t resolution) {
    const std::size_t count = arcs.from.size();
    auto run = KernelRun::probe("bounds", "bound_arcs", probe_options(lanes, 3, resolution));
    auto values = run.acu().plural<float>(4 * count);
    auto ranges = run.acu().plural<std::uint32_t>(2 * count);
    run.issue(probe_grid(count, lanes), run.plural(by_axis(arcs.from)),
              run.plural(by_axis(arcs.to)), std::int32_t(count), values, ranges);
    return {run.acu().unload(values), run.acu().unload(ranges)};
}

ExactBounds exact_bounds_of(const Arcs& arcs, std::size_t i) {
    ExactBounds bounds;
    include_arc(bounds, exact(arcs.from[i]), exact(arcs.to[i]));
    bounds.distance = distance_to(exact(arcs.from[i]), exact(arcs.to[i]));
    return bounds;
}

class EllipseBounds : public testing::TestWithParam<std::uint32_t> {};

INSTANTIATE_TEST_SUITE_P(Resolutions, EllipseBounds, testing::Values(64u, 1024u, 4096u));

TEST_P(EllipseBounds, AreNeverTooSmallAndTightToOneProxel) {
    const auto arcs = random_arcs(kArcs, 1e-3, 100);

    const auto bounds = bounds_of(arcs, 16, GetParam());

    int wide = 0;
    for (std::size_t i = 0; i < kArcs; ++i) {
        const auto expected = exact_bounds_of(arcs, i);
        // What kEdgeMargin may displace the arc by is no looseness but asked for.
        const double reach =
            std::min(glm::length(exact(arcs.from[i])), glm::length(exact(arcs.to[i]))) +
            kGridMargin / kEdgeMargin;
        const int granted =
            1 + static_cast<int>(0.5 * GetParam() * kEdgeMargin * reach / expected.distance);
        for (const auto& [range, interval] : {std::pair(bounds.ranges[i], expected.u),
                                              std::pair(bounds.ranges[kArcs + i], expected.v)}) {
            const auto beyond = excess(range, interval, GetParam());
            ASSERT_GE(std::min(beyond.before, beyond.after), 0) << "arc " << i;
            ASSERT_LE(std::max(beyond.before, beyond.after), granted) << "arc " << i;
            wide += beyond.before + beyond.after;
        }
    }
    RecordProperty("proxels_beyond", wide);
}

TEST(EllipseBoundsOfArcs, AreTheExactExtremaToSinglePrecision) {
    const auto arcs = random_arcs(kArcs, 1e-2, 101);

    const auto bounds = bounds_of(arcs, 16, 64);

    double worst = 0;
    for (std::size_t i = 0; i < kArcs; ++i) {
        const auto expected = exact_bounds_of(arcs, i);
        const double extrema[] = {expected.u.least, expected.u.most, expected.v.least,
                                  expected.v.most};
        for (std::size_t k = 0; k < 4; ++k)
            worst = std::max(worst, std::abs(bounds.values[k * kArcs + i] - extrema[k]));
    }
    // A plane at 1e-2 from the centre, of ends 3 sqrt 2 away, turns by their rounding over 1e-2.
    EXPECT_LT(worst, 8 * 0x1p-24 * 4.3 / 1e-2);
}

TEST(EllipseBoundsOfArcs, AreNeverTooSmallWhereTheLineAlmostMeetsTheShooter) {
    const auto arcs = random_arcs(kArcs, 1e-5, 102);

    const auto bounds = bounds_of(arcs, 16, 1024);

    for (std::size_t i = 0; i < kArcs; ++i) {
        const auto expected = exact_bounds_of(arcs, i);
        const auto columns = excess(bounds.ranges[i], expected.u, 1024);
        const auto rows = excess(bounds.ranges[kArcs + i], expected.v, 1024);
        ASSERT_GE(std::min({columns.before, columns.after, rows.before, rows.after}), 0)
            << "arc " << i;
    }
}

TEST(EllipseBoundsOfArcs, DoNotDependOnTheLanes) {
    const auto arcs = random_arcs(kArcs, 1e-3, 103);
    const auto wide = bounds_of(arcs, 16, 1024);

    for (const std::uint32_t lanes : {1u, 4u, 8u}) {
        const auto narrow = bounds_of(arcs, lanes, 1024);

        EXPECT_EQ(bits(narrow.values), bits(wide.values)) << lanes << " lanes";
        EXPECT_EQ(narrow.ranges, wide.ranges) << lanes << " lanes";
    }
}

}  // namespace
}  // namespace hemirad::test::ellipse_bounds_test
