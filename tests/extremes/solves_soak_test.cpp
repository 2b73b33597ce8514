#include "extremes/solves_many_shots.h"

// Minutes each.
namespace hemirad::test::solves_soak_test {
namespace {

constexpr double kPatchSize = 0.4;  // m; with fewer patches nothing is left to shoot before

TEST(AMillionShots, CloseTheirBooksByCounts) {
    expect_closed_books(FormFactorMode::count, 1'000'000, kPatchSize);
}

TEST(AMillionShots, CloseTheirBooksByClosedForms) {
    expect_closed_books(FormFactorMode::analytic, 1'000'000, kPatchSize);
}

}  // namespace
}  // namespace hemirad::test::solves_soak_test
