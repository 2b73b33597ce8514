#include "cli/text.h"

#include <gtest/gtest.h>

namespace hemirad::text_test {
namespace {

TEST(Text, DurationsHaveTheUnitOfTheirSize) {
    EXPECT_EQ(duration_text(0.0123), "12 ms");
    EXPECT_EQ(duration_text(3.21), "3.2 s");
    EXPECT_EQ(duration_text(200), "3 min 20 s");
    EXPECT_EQ(duration_text(7500), "2 h 5 min");
}

TEST(Text, DurationsCarryIntoTheNextUnit) {
    EXPECT_EQ(duration_text(0.9996), "1.0 s");
    EXPECT_EQ(duration_text(59.96), "1 min 0 s");
    EXPECT_EQ(duration_text(3599.6), "1 h 0 min");
}

TEST(Text, BytesHaveBinaryUnits) {
    EXPECT_EQ(bytes_text(1023), "1023 B");
    EXPECT_EQ(bytes_text(1536), "1.5 KiB");
    EXPECT_EQ(bytes_text(std::uint64_t{5} << 40), "5.0 TiB");
}

TEST(Text, NumbersReadBackAsTheSame) {
    EXPECT_EQ(number_text(0.1), "0.1");
    EXPECT_EQ(number_text(1e-9), "1e-09");
    EXPECT_EQ(std::stod(number_text(1.0 / 3)), 1.0 / 3);
}

TEST(Text, PeopleNeedFewerDigits) {
    EXPECT_EQ(rounded_text(31.41592653589794), "31.41593");
    EXPECT_EQ(rounded_text(2), "2");
    EXPECT_EQ(percent_text(0.98712), "98.7 %");
}

TEST(Text, CountsAgreeWithTheirNouns) {
    EXPECT_EQ(counted(1, "patch", "patches"), "1 patch");
    EXPECT_EQ(counted(2, "patch", "patches"), "2 patches");
    EXPECT_EQ(counted(0, "shot"), "0 shots");
}

}  // namespace
}  // namespace hemirad::text_test
