#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <random>

#include "support/patch_database.h"
#include "support/probe.h"

namespace hemirad::test::hemisphere_test {
namespace {

using glm::dvec3;

constexpr std::size_t kDirections = 16 * 16384;  // of each of four shooters: a million
constexpr double kNear = 3e-6;  // four margins: what rounding might lose lies much closer

using Triangle = std::array<Steps, 3>;

// Neighbouring patches, and a direction near to what they share, of the shooter's frame.
struct Case {
    std::vector<Triangle> patches;
    Float3 direction;
};

dvec3 vector_of(const float* v) { return {v[0], v[1], v[2]}; }

class World {
  public:
    explicit World(unsigned seed) : random_(seed), shot_(shot_from(0.5 * point(), point())) {}

    const device::Shot& shot() const { return shot_; }
    /// A case about the shooter, from as large as the world to a ten-thousandth of it.
    void rescale() { size_ = std::pow(10.0, between(-4, -0.3)); }
    double size() const { return size_; }
    dvec3 place() { return origin() + size_ * point(); }
    dvec3 point() { return {any(), any(), any()}; }
    double any() { return 2 * std::generate_canonical<double, 53>(random_) - 1; }
    double between(double low, double high) { return low + (high - low) * (0.5 + 0.5 * any()); }
    dvec3 origin() const { return grid_point(shot_.origin); }

    // As the kernels turn it, in double precision.
    Float3 direction_to(const dvec3& target) const {
        const auto x = target - origin();
        return rounded(glm::normalize(dvec3(glm::dot(vector_of(shot_.u_axis), x),
                                            glm::dot(vector_of(shot_.v_axis), x),
                                            glm::dot(vector_of(shot_.normal), x))));
    }
    // Where the line p -> q passes to the left of x, seen from the origin: inside is positive.
    double moment(const Steps& p, const Steps& q, const dvec3& x) const {
        const auto a = exact(p) - origin(), b = exact(q) - origin();
        return glm::dot(glm::cross(b, a), x - origin()) / glm::length(b - a) /
               glm::length(x - origin());
    }
    bool above(const dvec3& x) const {
        return glm::dot(vector_of(shot_.normal), x - origin()) > 1e-3 * size_;
    }

  private:
    std::mt19937 random_;
    device::Shot shot_;
    double size_ = 1;
};

bool well_inside(const World& world, const Triangle& patch, const dvec3& x, int but_edge) {
    for (int k = 0; k < 3; ++k)
        if (k != but_edge && world.moment(patch[k], patch[(k + 1) % 3], x) < 1e-4 * world.size())
            return false;
    return true;
}

// Two triangles to the left and the right of an edge, which they list in reverse.
std::optional<Case> shared_edge(World& world) {
    const auto a = on_grid(world.place()), b = on_grid(world.place()), c = on_grid(world.place()),
               d = on_grid(world.place());
    const auto along = exact(b) - exact(a);
    if (glm::length(along) < 0.05 * world.size()) return {};
    const auto x = exact(a) + world.between(0, 1) * along + kNear * world.size() * world.point();
    const Triangle left = {a, b, c}, right = {b, a, d};
    if (!world.above(x) || !well_inside(world, left, x, 0) || !well_inside(world, right, x, 0))
        return {};
    return Case{{left, right}, world.direction_to(x)};
}

// An edge on one side, on the other two that meet at a vertex rounded off it.
std::optional<Case> t_junction(World& world) {
    const auto a = on_grid(world.place()), b = on_grid(world.place()), c = on_grid(world.place()),
               d = on_grid(world.place());
    const auto along = exact(b) - exact(a);
    if (glm::length(along) < 0.05 * world.size()) return {};
    const auto vertex = on_grid(exact(a) + world.between(0.2, 0.8) * along);
    const auto x = exact(vertex) + kNear * world.size() * world.point();
    const Triangle left = {a, b, c}, right = {b, a, d};
    if (!world.above(x) || !well_inside(world, left, x, 0) || !well_inside(world, right, x, 0))
        return {};
    return Case{{left, {b, vertex, d}, {vertex, a, d}}, world.direction_to(x)};
}

// Five triangles all around a vertex.
std::optional<Case> shared_vertex(World& world) {
    const auto centre = on_grid(world.place());
    const auto towards = exact(centre) - world.origin();
    if (glm::length(towards) < 0.1 * world.size() || !world.above(exact(centre))) return {};
    const auto forward = glm::normalize(towards);
    const auto side = glm::normalize(glm::cross(forward, world.point()));
    const auto up = glm::cross(side, forward);
    std::vector<Steps> rim;
    for (int k = 0; k < 5; ++k) {
        const double angle = -2 * std::numbers::pi / 5 * (k + 0.3 * world.any());
        const double radius = world.between(0.02, 0.5) * glm::length(towards);
        rim.push_back(
            on_grid(exact(centre) + radius * (std::cos(angle) * side + std::sin(angle) * up +
                                              0.3 * world.any() * forward)));
    }
    Case result{{}, world.direction_to(exact(centre) + kNear * world.size() * world.point())};
    for (int k = 0; k < 5; ++k) result.patches.push_back({centre, rim[k], rim[(k + 1) % 5]});
    // Clockwise or not, as seen from here: all triangles have the third corner inside.
    for (auto& patch : result.patches)
        if (world.moment(patch[0], patch[1], exact(patch[2])) < 0) std::swap(patch[1], patch[2]);
    return result;
}

std::vector<Case> cases_of(std::optional<Case> (*make)(World&), World& world) {
    std::vector<Case> cases;
    while (cases.size() < kDirections) {
        world.rescale();
        if (auto one = make(world)) cases.push_back(*std::move(one));
    }
    return cases;
}

// Of each case, how many of its patches claim its direction.
std::vector<int> claim_counts(const World& world, const std::vector<Case>& cases,
                              std::uint32_t lanes) {
    auto run = KernelRun::probe("hemisphere", "claims", probe_options(lanes));
    std::vector<Float3> directions;
    for (const auto& one : cases) directions.push_back(one.direction);
    std::vector<int> counts(cases.size());
    for (std::size_t patch = 0; patch < cases.front().patches.size(); ++patch) {
        std::vector<std::int32_t> corners;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const auto& one : cases) corners.push_back(one.patches[patch][k][axis]);
        auto claimed = run.acu().plural<std::int32_t>(cases.size());
        run.issue({cases.size() / lanes / 64, 64}, run.plural(std::vector{world.shot()}),
                  run.plural(corners), run.plural(by_axis(directions)), std::int32_t(cases.size()),
                  claimed);
        const auto masks = run.acu().unload(claimed);
        for (std::size_t i = 0; i < masks.size(); ++i) counts[i] -= masks[i];
    }
    return counts;
}

std::int64_t unclaimed(const World& world, const std::vector<Case>& cases, std::uint32_t lanes) {
    const auto counts = claim_counts(world, cases, lanes);
    return std::count(counts.begin(), counts.end(), 0);
}

class Hemisphere : public testing::TestWithParam<std::uint32_t> {};  // lanes

INSTANTIATE_TEST_SUITE_P(Lanes, Hemisphere, testing::ValuesIn(all_lanes()));

TEST_P(Hemisphere, NoDirectionIsLostBetweenPatchesThatShareAnEdge) {
    World world(120 + GetParam());

    EXPECT_EQ(unclaimed(world, cases_of(shared_edge, world), GetParam()), 0);
}

TEST_P(Hemisphere, NoDirectionIsLostWhereAVertexLiesOnANeighboursEdge) {
    World world(140 + GetParam());

    EXPECT_EQ(unclaimed(world, cases_of(t_junction, world), GetParam()), 0);
}

TEST_P(Hemisphere, NoDirectionIsLostAroundAVertex) {
    World world(160 + GetParam());

    EXPECT_EQ(unclaimed(world, cases_of(shared_vertex, world), GetParam()), 0);
}

TEST_P(Hemisphere, FartherThanTwoMarginsFromAnEdgeOnlyOneSideClaims) {
    World world(180 + GetParam());
    const auto cases = cases_of(shared_edge, world);

    const auto counts = claim_counts(world, cases, GetParam());

    std::size_t far = 0, both = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto& edge = cases[i].patches[0];
        const auto x = exact(cases[i].direction);
        const auto target = world.origin() + x.x * vector_of(world.shot().u_axis) +
                            x.y * vector_of(world.shot().v_axis) +
                            x.z * vector_of(world.shot().normal);
        const double reach = std::min(glm::distance(exact(edge[0]), world.origin()),
                                      glm::distance(exact(edge[1]), world.origin()));
        const bool is_far = std::abs(world.moment(edge[0], edge[1], target)) >
                            2 * (kEdgeMargin * reach + kGridMargin);
        far += is_far;
        both += is_far && counts[i] > 1;
    }
    EXPECT_GT(far, 1000u);
    EXPECT_EQ(both, 0u);
}

TEST_P(Hemisphere, AReversedEdgeIsTheNegatedPlane) {
    World world(200);
    std::vector<Float3> from(4096), to(4096);
    std::generate(from.begin(), from.end(), [&] { return rounded(2.0 * world.point()); });
    std::generate(to.begin(), to.end(), [&] { return rounded(2.0 * world.point()); });
    auto run = KernelRun::probe("hemisphere", "edge_planes", probe_options(GetParam()));
    auto planes = run.acu().plural<float>(3 * 4096), reversed = run.acu().plural<float>(3 * 4096);

    run.issue(probe_grid(4096, GetParam()), run.plural(by_axis(from)), run.plural(by_axis(to)),
              std::int32_t(4096), planes);
    run.issue(probe_grid(4096, GetParam()), run.plural(by_axis(to)), run.plural(by_axis(from)),
              std::int32_t(4096), reversed);

    const auto one = run.acu().unload(planes), other = run.acu().unload(reversed);
    for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i], -other[i]);
}

}  // namespace
}  // namespace hemirad::test::hemisphere_test
