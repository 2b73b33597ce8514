#include <gtest/gtest.h>

#include <iostream>

#include "extremes/random_scenes.h"

// Random small scenes, device against double precision: every proxel that the device's bound leaves
// one owner has that owner, every other one of those that the bound admits.
namespace hemirad::test::soup_test {
namespace {

constexpr std::uint64_t kScenesAShooter = 16;

struct Tally {
    Agreement all;
    std::uint64_t scenes = 0, wrong_scenes = 0;
};

// As few patches as still show the difference.
std::vector<Polygon> minimised(Stage& stage, std::vector<Polygon> polygons) {
    for (std::size_t patch = polygons.size() - 1; patch > 2; --patch) {
        std::vector<Polygon> fewer;
        for (std::size_t other = 0; other < polygons.size(); ++other)
            if (other != patch) fewer.push_back(polygons[other]);
        stage.show(fewer);
        if (stage.agreement_of(0).wrong > 0) polygons = fewer;
    }
    return polygons;
}

void report(Stage& stage, const std::vector<Polygon>& polygons, std::uint64_t seed) {
    const auto fewest = minimised(stage, polygons);
    stage.show(fewest);
    const auto result = stage.agreement_of(0);
    ADD_FAILURE() << "seed " << seed << ", resolution " << stage.resolution() << ", patch 0 sees "
                  << result.wrong << " wrong proxels, " << result.first_wrong << "\n"
                  << text(fewest);
}

bool all_finite(const device::Projection& projection) {
    bool finite = true;
    for (const auto& edge : projection.edge)
        for (const float value : edge) finite = finite && std::isfinite(value);
    for (const float value : projection.depth) finite = finite && std::isfinite(value);
    return finite;
}

void add_scenes_of(std::uint64_t seed, Stage& stage, Tally& tally) {
    BadNeighbours neighbours(seed);
    const Polygon shooter = neighbours.shooter_patch();
    stage.show(BadNeighbours::fixed_patches(shooter));
    const auto frame = stage.in_world(stage.aim(0));
    for (std::uint64_t i = 0; i < kScenesAShooter; ++i) {
        const auto polygons = neighbours.scene(shooter, frame, stage.resolution());
        stage.show(polygons);
        const auto result = stage.agreement_of(0);
        tally.all += result;
        ++tally.scenes;
        for (const auto& projection : stage.pipeline().projections())
            EXPECT_TRUE(all_finite(projection)) << "seed " << seed << ", scene " << i;
        if (result.wrong > 0 && tally.wrong_scenes++ < 8) report(stage, polygons, seed);
    }
}

void expect_agreement(std::uint64_t first_seed, std::uint64_t scenes) {
    Stage stage(64);
    Tally tally;
    for (std::uint64_t seed = first_seed; tally.scenes < scenes; ++seed)
        add_scenes_of(seed, stage, tally);

    EXPECT_EQ(tally.wrong_scenes, 0u);
    std::cout << "limit: soup | " << tally.scenes << " scenes | " << tally.all.proxels
              << " proxels | " << tally.all.undecided << " undecided | " << tally.all.wrong
              << " wrong in " << tally.wrong_scenes << " scenes\n";
    testing::Test::RecordProperty("undecided_proxels", std::to_string(tally.all.undecided));
    testing::Test::RecordProperty("wrong_proxels", std::to_string(tally.all.wrong));
}

bool is_a_factor(float value) { return value >= 0 && value <= 1; }  // no for NaN

void expect_factors(std::uint64_t first_seed, std::uint64_t scenes) {
    Stage stage(64, FormFactorMode::analytic);
    std::uint64_t shown = 0, above_zero = 0;
    for (std::uint64_t seed = first_seed; shown < scenes; ++seed) {
        BadNeighbours neighbours(seed);
        const Polygon shooter = neighbours.shooter_patch();
        stage.show(BadNeighbours::fixed_patches(shooter));
        const auto frame = stage.in_world(stage.aim(0));
        for (std::uint64_t i = 0; i < kScenesAShooter; ++i, ++shown) {
            stage.show(neighbours.scene(shooter, frame, stage.resolution()));
            stage.owners_seen_by(0);
            for (const float factor : stage.pipeline().factors()) {
                EXPECT_TRUE(is_a_factor(factor)) << "seed " << seed << ", scene " << i;
                above_zero += factor > 0;
            }
        }
    }
    EXPECT_GT(above_zero, shown);
}

TEST(Soup, AnalyticFactorsLieBetweenZeroAndOne) { expect_factors(1, 2000); }

TEST(LongSoup, AnalyticFactorsLieBetweenZeroAndOne) { expect_factors(2000000, 100000); }

TEST(Soup, OwnersOfThreeThousandScenesAreThoseOfDoublePrecision) { expect_agreement(1, 3000); }

TEST(LongSoup, OwnersOfAHundredThousandScenesAreThoseOfDoublePrecision) {
    expect_agreement(1000000, 100000);
}

}  // namespace
}  // namespace hemirad::test::soup_test
