#include "scene/short_text.h"

#include <gtest/gtest.h>

#include <vector>

namespace hemirad::short_text_test {
namespace {

std::string in_short(const std::vector<std::string>& names, std::size_t most) {
    return names_in_short(names.size(), most, [&](std::size_t i) { return names[i]; });
}

TEST(ShortText, FewNamesAreAllThere) {
    EXPECT_EQ(in_short({}, 2), "");
    EXPECT_EQ(in_short({"a"}, 2), "a");
    EXPECT_EQ(in_short({"a", "b"}, 2), "a, b");
}

TEST(ShortText, OfManyNamesTheRestIsCounted) {
    EXPECT_EQ(in_short({"a", "b", "c", "d"}, 2), "a, b and 2 more");
    EXPECT_EQ(in_short({"a", "b"}, 1), "a and 1 more");
}

TEST(ShortText, SizesAreWidthTimesHeight) { EXPECT_EQ(size_text(640, 480), "640 x 480"); }

}  // namespace
}  // namespace hemirad::short_text_test
