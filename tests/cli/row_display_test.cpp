#include "cli/row_display.h"

#include <gtest/gtest.h>

namespace hemirad::row_display_test {
namespace {

TEST(RowDisplay, RowsLeftTakeAsLongAsThoseDone) {
    EXPECT_EQ(row_text(10, 40, 4.0, false), "10 of 40 rows, 12.0 s left");
    EXPECT_EQ(row_text(40, 40, 4.0, false), "40 of 40 rows, 0 ms left");
}

TEST(RowDisplay, NothingIsForetoldInTheFirstSecondsOrFromFewRows) {
    EXPECT_EQ(row_text(0, 1, 4.0, false), "0 of 1 row");
    EXPECT_EQ(row_text(10, 40, 2.9, false), "10 of 40 rows");
    EXPECT_EQ(row_text(9, 1000, 60.0, false), "9 of 1000 rows");
    EXPECT_EQ(row_text(10, 1000, 60.0, false), "10 of 1000 rows, 1 h 39 min left");
}

TEST(RowDisplay, TheBarGrowsWithTheRows) {
    EXPECT_EQ(row_text(10, 40, 4.0, true), "[======                  ] 10 of 40 rows, 12.0 s left");
    EXPECT_EQ(row_text(40, 40, 4.0, true).substr(0, 26), "[========================]");
}

}  // namespace
}  // namespace hemirad::row_display_test
