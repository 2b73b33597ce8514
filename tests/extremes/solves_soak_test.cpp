#include "extremes/solves_many_shots.h"
#include "extremes/solves_one_shot.h"

// Minutes each.
namespace hemirad::test {
namespace {

TEST(AMillionShots, CloseTheirBooksByCounts) {
    expect_closed_books(FormFactorMode::count, 1'000'000);
}

TEST(AMillionShots, CloseTheirBooksByClosedForms) {
    expect_closed_books(FormFactorMode::analytic, 1'000'000);
}

TEST(TwoMillionPatches, TakeOneShotByCounts) {
    const Mesh mesh = lamp_above_floor(2000, 1000);
    ASSERT_EQ(mesh.patches.size(), 2'000'001u);
    expect_one_shot(mesh, one_shot(FormFactorMode::count, 512));
}

}  // namespace
}  // namespace hemirad::test
