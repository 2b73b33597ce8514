#include "extremes/solves_many_shots.h"

// Minutes each.
namespace hemirad::test {
namespace {

TEST(AMillionShots, CloseTheirBooksByCounts) {
    expect_closed_books(FormFactorMode::count, 1'000'000);
}

TEST(AMillionShots, CloseTheirBooksByClosedForms) {
    expect_closed_books(FormFactorMode::analytic, 1'000'000);
}

}  // namespace
}  // namespace hemirad::test
