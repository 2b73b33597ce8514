#include "extremes/solves_many_shots.h"

// Energy is neither made nor lost by many shots; solves_long_test and solves_soak_test have more.
namespace hemirad::test::solves_ledger_test {
namespace {

TEST(ManyShots, CloseTheirBooksByCountsAfterTenThousand) {
    expect_closed_books(FormFactorMode::count, 10'000);
}

TEST(ManyShots, CloseTheirBooksByClosedFormsAfterTenThousand) {
    expect_closed_books(FormFactorMode::analytic, 10'000);
}

}  // namespace
}  // namespace hemirad::test::solves_ledger_test
