#include "scene/printable.h"

#include <gtest/gtest.h>

namespace hemirad::printable_test {
namespace {

TEST(Printable, LeavesTextAsItIs) {
    EXPECT_EQ(printable("h\u00f6he \u2113 \U0001f4a1 back\\slash"),
              "h\u00f6he \u2113 \U0001f4a1 back\\slash");
}

TEST(Printable, EscapesControlCharacters) {
    EXPECT_EQ(printable("a\nb\x1b[31m\x7f"), "a\\x0ab\\x1b[31m\\x7f");
    EXPECT_EQ(printable("\u009b31m"), "\\xc2\\x9b31m");
}

TEST(Printable, EscapesWhatIsNoUtf8) {
    EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
    EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
    EXPECT_EQ(printable("\xe2\x84"), "\\xe2\\x84");                    // cut short
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
}

TEST(Printable, GoesOnAfterABadByte) { EXPECT_EQ(printable("\xe2o\xc3\xb6"), "\\xe2o\xc3\xb6"); }

}  // namespace
}  // namespace hemirad::printable_test
