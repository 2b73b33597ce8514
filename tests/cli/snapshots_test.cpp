#include "cli/snapshots.h"

#include <gtest/gtest.h>

#include "cli/shot_clock.h"

namespace hemirad::snapshots_test {
namespace {

TEST(Snapshots, AreNeverDueUnlessAskedFor) {
    EXPECT_FALSE(Snapshots({}).due({.shots = 1000, .seconds = 1000}));
}

TEST(Snapshots, AreDueOncePerIntervalOfShots) {
    Snapshots snapshots({.shots = 10});

    EXPECT_FALSE(snapshots.due({.shots = 9}));
    EXPECT_TRUE(snapshots.due({.shots = 10}));
    EXPECT_FALSE(snapshots.due({.shots = 19}));
    EXPECT_TRUE(snapshots.due({.shots = 45}));  // three were missed: one picture does
    EXPECT_FALSE(snapshots.due({.shots = 49}));
}

TEST(Snapshots, OfASolveThatGoesOnAreThoseOfAWholeOne) {
    Snapshots snapshots({.shots = 10}, 23);

    EXPECT_FALSE(snapshots.due({.shots = 24}));
    EXPECT_TRUE(snapshots.due({.shots = 30}));
}

TEST(Snapshots, AreDueOncePerIntervalOfTime) {
    Snapshots snapshots({.seconds = 2});

    EXPECT_FALSE(snapshots.due({.seconds = 1.9}));
    EXPECT_TRUE(snapshots.due({.seconds = 2.1}));
    EXPECT_FALSE(snapshots.due({.seconds = 3.9}));
    EXPECT_TRUE(snapshots.due({.seconds = 4.0}));
}

/// Such intervals have passed more often than an integer, or even a double, counts.
TEST(Snapshots, OfTheShortestIntervalsAreDueWheneverAsked) {
    for (const double interval : {1e-30, 1e-320}) {
        Snapshots snapshots({.seconds = interval});

        EXPECT_TRUE(snapshots.due({.seconds = 1}));
        EXPECT_TRUE(snapshots.due({.seconds = 2}));
    }
}

TEST(ShotClock, TakesTheMedianOfItsIntervals) {
    ShotClock clock;
    EXPECT_EQ(clock.median(), 0);

    clock.note({.shots = 1, .seconds = 1});     // 1 s a shot
    clock.note({.shots = 11, .seconds = 3});    // 0.2
    clock.note({.shots = 21, .seconds = 103});  // 10: something else took the machine

    EXPECT_DOUBLE_EQ(clock.median(), 1);
}

}  // namespace
}  // namespace hemirad::snapshots_test
