#include "cli/eta.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hemirad::eta_test {
namespace {

TEST(Eta, IsUnknownWithoutDecay) {
    Eta eta(1e-3);
    EXPECT_FALSE(eta.remaining());

    eta.note(0, 1);
    eta.note(1, 1);

    EXPECT_FALSE(eta.remaining());
}

TEST(Eta, IsUnknownInTheFirstSeconds) {
    Eta eta(1e-3);

    eta.note(0, 1);
    eta.note(2.9, 0.5);
    EXPECT_FALSE(eta.remaining());

    eta.note(3, 0.5);
    EXPECT_TRUE(eta.remaining());
}

TEST(Eta, IsUnknownInTheFirstHundredthOfTheWay) {
    Eta eta(1e-3);

    eta.note(0, 1);
    eta.note(4, std::pow(1e-3, 0.009));
    EXPECT_FALSE(eta.remaining());

    eta.note(5, std::pow(1e-3, 0.011));
    EXPECT_TRUE(eta.remaining());
}

TEST(Eta, IsToldUpToAThousandHours) {
    EXPECT_EQ(left_text({}), "");
    EXPECT_EQ(left_text(200), ", 3 min 20 s left");
    EXPECT_EQ(left_text(3.6e6), ", 1000 h 0 min left");
    EXPECT_EQ(left_text(3.7e6), "");
}

TEST(Eta, IsExactForASteadyDecay) {
    Eta eta(1e-3);

    for (int second = 0; second <= 4; ++second) eta.note(second, std::pow(10.0, -second / 4.0));

    EXPECT_NEAR(eta.remaining().value(), 8, 1e-9);
}

TEST(Eta, GoesByTheLaterHalf) {
    Eta eta(1e-3);

    eta.note(0, 1);
    eta.note(2, 1e-2);  // bright emitters first
    eta.note(4, 1e-2 * std::exp(-0.2));

    EXPECT_NEAR(eta.remaining().value(), (std::log(10.0) - 0.2) / 0.1, 1e-9);
}

TEST(Eta, IsNothingBelowTheTolerance) {
    Eta eta(1e-3);

    eta.note(0, 1);
    eta.note(1, 1e-4);

    EXPECT_EQ(eta.remaining().value(), 0);
}

}  // namespace
}  // namespace hemirad::eta_test
