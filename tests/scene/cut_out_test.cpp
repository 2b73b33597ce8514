#include "scene/cut_out.h"

#include <gtest/gtest.h>

#include <ctime>
#include <glm/geometric.hpp>

#include "support/seconds_since.h"

namespace hemirad::cut_out_test {
namespace {

Outline square(double x, double y, double size) {
    return {{x, y, 0}, {x + size, y, 0}, {x + size, y + size, 0}, {x, y + size, 0}};
}

TEST(CutOut, ThousandsOfHolesLeaveTheRestSoon) {
    constexpr int kSide = 70;
    std::vector<Outline> holes;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) holes.push_back(square(x + 0.25, y + 0.25, 0.5));
    const auto start = std::clock();

    const auto pieces = cut_out(square(0, 0, kSide), holes);

    EXPECT_LT(test::seconds_since(start), 2.5);
    double doubled = 0;
    for (const Outline& piece : pieces) doubled += glm::length(doubled_area(piece));
    EXPECT_NEAR(doubled / 2, 0.75 * kSide * kSide, 1e-9);
}

}  // namespace
}  // namespace hemirad::cut_out_test
