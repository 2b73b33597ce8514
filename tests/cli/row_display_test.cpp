#include "cli/row_display.h"

#include <gtest/gtest.h>

namespace hemirad::row_display_test {
namespace {

TEST(RowDisplay, RowsLeftTakeAsLongAsThoseDone) {
    EXPECT_EQ(row_text(10, 40, 1.0, false), "10 of 40 rows, 3.0 s left");
    EXPECT_EQ(row_text(40, 40, 1.0, false), "40 of 40 rows, 0 ms left");
}

TEST(RowDisplay, WithoutARowNothingIsForetold) {
    EXPECT_EQ(row_text(0, 1, 1.0, false), "0 of 1 row, ? left");
}

TEST(RowDisplay, TheBarGrowsWithTheRows) {
    EXPECT_EQ(row_text(10, 40, 1.0, true), "[======                  ] 10 of 40 rows, 3.0 s left");
    EXPECT_EQ(row_text(40, 40, 1.0, true).substr(0, 26), "[========================]");
}

}  // namespace
}  // namespace hemirad::row_display_test
