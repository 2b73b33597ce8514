#include "reference/gauss_seidel.h"

#include <gtest/gtest.h>

#include "tests/reference/shapes.h"

namespace hemirad::reference::gauss_seidel_test {
namespace {

FormFactorMatrix doubly_stochastic_cube() {
    FormFactorMatrix matrix(6);
    for (std::size_t from = 0; from < 6; ++from)
        for (std::size_t to = 0; to < 6; ++to) matrix.at(from, to) = from == to ? 0 : 0.2;
    return matrix;
}

TEST(GaussSeidel, GivesAFurnaceEOverOneLessRho) {
    const std::vector<double> areas(6, 4.0);
    const std::vector<double> emitted(6, 3.0);
    for (const double rho : {0.0, 0.5, 0.9, 0.99}) {
        const std::vector<double> reflectance(6, rho);

        const auto solution = solve(doubly_stochastic_cube(), areas, Band{reflectance, emitted});

        EXPECT_TRUE(solution.converged);
        for (const double radiosity : solution.radiosity)
            EXPECT_NEAR(radiosity * (1 - rho) / 3, 1, 1e-12);
    }
}

// Two patches of areas 1 and 2, F_12 = 0.4, so F_21 = 0.2. With E = (1, 0) and rho = (0.5, 0.8):
// B1 = 1 + 0.5 * 0.4 * B2 and B2 = 0.8 * 0.2 * B1, thus B1 = 1 / (1 - 0.032).
TEST(GaussSeidel, SolvesTwoPatchesAsByHand) {
    FormFactorMatrix matrix(2);
    matrix.at(0, 1) = 0.4;
    matrix.at(1, 0) = 0.2;
    const std::vector<double> areas = {1, 2}, reflectance = {0.5, 0.8}, emitted = {1, 0};

    const auto solution = solve(matrix, areas, Band{reflectance, emitted});

    const double b1 = 1 / (1 - 0.032);
    EXPECT_NEAR(solution.radiosity[0], b1, 1e-14);
    EXPECT_NEAR(solution.radiosity[1], 0.16 * b1, 1e-14);
    EXPECT_NEAR(solution.irradiance[1], 0.2 * b1, 1e-14);
    EXPECT_NEAR(solution.balance.emitted, 1, 1e-14);
    EXPECT_NEAR(solution.balance.escaped, 0.6 * b1 + 0.8 * 2 * 0.16 * b1, 1e-14);
    EXPECT_NEAR(solution.balance.absorbed, 0.5 * 0.4 * 0.16 * b1 + 0.2 * 2 * 0.2 * b1, 1e-14);
}

// The receiver is four times the emitter and takes all of its flux: a quarter of its radiosity.
// With the factor of the wrong direction it would take all of it.
TEST(GaussSeidel, SpreadsFluxOverTheReceiversArea) {
    FormFactorMatrix matrix(2);
    matrix.at(0, 1) = 1;
    const std::vector<double> areas = {1, 4}, reflectance = {0, 0.5}, emitted = {2, 0};

    const auto solution = solve(matrix, areas, Band{reflectance, emitted});

    EXPECT_DOUBLE_EQ(solution.irradiance[1], 0.5);
    EXPECT_DOUBLE_EQ(solution.radiosity[1], 0.25);
}

TEST(GaussSeidel, KeepsEveryFluxOfARoomThatLeaks) {
    auto walls = room({1, 0.7, 0.4}, 2);
    walls.erase(walls.begin() + 5);
    std::vector<double> areas, reflectance, emitted;
    for (std::size_t patch = 0; patch < walls.size(); ++patch) {
        areas.push_back(area(walls[patch]));
        reflectance.push_back(0.05 * double(patch % 19));
        emitted.push_back(patch == 3 ? 10 : 0);
    }

    const auto solution = solve(form_factor_matrix(walls, 64), areas, Band{reflectance, emitted});

    const Balance& balance = solution.balance;
    EXPECT_TRUE(solution.converged);
    EXPECT_GT(balance.escaped, 0.01 * balance.emitted);
    EXPECT_NEAR((balance.absorbed + balance.escaped) / balance.emitted, 1, 1e-11);
}

TEST(GaussSeidel, SolvesEachBandByItself) {
    const std::vector<double> areas(6, 1.0), emitted(6, 1.0), dark(6, 0.2), bright(6, 0.8);
    const std::vector<Band> bands = {{dark, emitted}, {bright, emitted}};

    const auto solutions = solve(doubly_stochastic_cube(), areas, bands);

    ASSERT_EQ(solutions.size(), 2u);
    EXPECT_NEAR(solutions[0].radiosity[0], 1.25, 1e-11);
    EXPECT_NEAR(solutions[1].radiosity[0], 5, 1e-11);
}

TEST(GaussSeidel, LeavesADarkSceneDark) {
    const std::vector<double> areas(6, 1.0), emitted(6, 0.0), reflectance(6, 0.9);

    const auto solution = solve(doubly_stochastic_cube(), areas, Band{reflectance, emitted});

    EXPECT_TRUE(solution.converged);
    EXPECT_EQ(solution.radiosity, emitted);
}

TEST(GaussSeidel, SaysWhenItStopsShort) {
    const std::vector<double> areas(6, 1.0), emitted(6, 1.0), reflectance(6, 0.9);

    EXPECT_FALSE(
        solve(doubly_stochastic_cube(), areas, Band{reflectance, emitted}, 1e-12, 2).converged);
}

}  // namespace
}  // namespace hemirad::reference::gauss_seidel_test
