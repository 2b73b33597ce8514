#pragma once

#include <gtest/gtest.h>

#include "solver/solver.h"

namespace hemirad::test {

/// What a solve ended with.
struct Solved {
    Solution solution;
    Closure closure;
    std::uint64_t repeated_shots;  ///< not compared: they depend on the rows that were kept
};

inline void expect_equal(const Solved& a, const Solved& b) {
    EXPECT_EQ(a.solution.shots, b.solution.shots);
    EXPECT_EQ(a.solution.irradiance, b.solution.irradiance);
    EXPECT_EQ(a.solution.shots_of, b.solution.shots_of);
    EXPECT_EQ(a.solution.unshot_fraction, b.solution.unshot_fraction);
    EXPECT_EQ(a.solution.converged, b.solution.converged);
    EXPECT_EQ(a.closure.least, b.closure.least);
    EXPECT_EQ(a.closure.most, b.closure.most);
    for (std::size_t band = 0; band < a.solution.ledger.size(); ++band) {
        EXPECT_EQ(a.solution.ledger[band].escaped, b.solution.ledger[band].escaped);
        EXPECT_EQ(a.solution.ledger[band].unshot, b.solution.ledger[band].unshot);
    }
}

}  // namespace hemirad::test
