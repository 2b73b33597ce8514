#include "cli/option_values.h"

#include <gtest/gtest.h>

#include <cmath>

#include "errors.h"

namespace hemirad::option_values_test {
namespace {

OptionValue value(std::string_view text) { return {"--size", text}; }

std::string complaint(auto read) {
    try {
        read();
    } catch (const InputError& fault) {
        return fault.what();
    }
    return "";
}

TEST(OptionValues, WholeNumbersIncludeBothLimits) {
    EXPECT_EQ(whole_number(value("16"), 16, 8192), 16u);
    EXPECT_EQ(whole_number(value("8192"), 16, 8192), 8192u);
    EXPECT_THROW(whole_number(value("15"), 16, 8192), InputError);
    EXPECT_THROW(whole_number(value("8193"), 16, 8192), InputError);
}

TEST(OptionValues, BytesHaveUnitsOfTwoToTheTenth) {
    EXPECT_EQ(byte_count(value("123")), 123u);
    EXPECT_EQ(byte_count(value("1.5K")), 1536u);
    EXPECT_EQ(byte_count(value("500M")), std::uint64_t{500} << 20);
    EXPECT_EQ(byte_count(value("8G")), std::uint64_t{8} << 30);
    for (const char* text : {"", "G", "0", "-1M", "1X", "nan", "1e40T"})
        EXPECT_THROW(byte_count(value(text)), InputError) << text;
}

TEST(OptionValues, NumbersMayBeInfiniteOnlyWhereThatMeansSomething) {
    EXPECT_TRUE(std::isinf(positive_or_infinite(value("inf"))));
    EXPECT_THROW(positive_number(value("inf")), InputError);
}

TEST(OptionValues, NumbersLeaveNoRest) {
    for (const auto* text : {"", " 1", "1 ", "1m", "1,5", "0x10", "--1"})
        EXPECT_THROW(positive_number(value(text)), InputError) << text;
}

TEST(OptionValues, ExtentsHaveTwoSides) {
    const auto [width, height] = extent(value("32x8"));

    EXPECT_EQ(width, 32u);
    EXPECT_EQ(height, 8u);
    for (const auto* text : {"32", "x", "32x", "x8", "0x8", "32x8x1", "32X8", "32x-8"})
        EXPECT_THROW(extent(value(text)), InputError) << text;
}

TEST(OptionValues, WordsAreGivenByIndex) {
    EXPECT_EQ(one_of(value("cull"), {"auto", "block", "cull"}), 2u);
}

TEST(OptionValues, ComplaintsNameOptionValueAndWhatIsAccepted) {
    EXPECT_EQ(complaint([] { whole_number(value("x"), 1, 2); }),
              "hemirad: --size \"x\": expected a whole number from 1 to 2");
    EXPECT_EQ(complaint([] {
                  one_of(value("b"), {"a", "c", "d"});
              }),
              "hemirad: --size \"b\": expected a, c or d");
}

}  // namespace
}  // namespace hemirad::option_values_test
